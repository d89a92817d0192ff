#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "compare/cause/class_map.hpp"
#include "compare/image/difference.hpp"
#include "compare/image/flip/flip.hpp"
#include "pathtracer/image/image_io.hpp"
#include "tools/command.hpp"
#include "tools/options/comparison_options.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/output/junit.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/output/run_record.hpp"
#include "tools/report/baseline.hpp"
#include "tools/report/baseline_report.hpp"
#include "tools/report/comparison_report.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/report_page.hpp"

namespace tandem::tools {
namespace {

/// All that `tandem diff` found out.
struct Findings {
  compare::Comparison comparison;
  std::optional<Baseline> baseline;  ///< where a stored run was given
  std::string date;
  std::string command;  ///< the command line
};

struct Options {
  RenderOptions render;
  ComparisonArguments comparison;
  std::filesystem::path json;      ///< empty: none
  std::filesystem::path junit;     ///< empty: none
  std::filesystem::path folder;    ///< empty: no images
  std::filesystem::path report;    ///< the folder of the page; empty: none
  std::filesystem::path baseline;  ///< the folder of a stored run; empty: none
  pathtracer::Tone tone;
};

bool is_same_file(const std::filesystem::path& first, const std::filesystem::path& second) {
  return std::filesystem::weakly_canonical(first) == std::filesystem::weakly_canonical(second);
}

/// The worst of the verdicts.
compare::Outcome outcome_of(const Findings& findings) {
  const compare::Outcome today = findings.comparison.verdict.outcome;
  return findings.baseline ? compare::worse(today, findings.baseline->outcome()) : today;
}

/// A sentence for each thing that is not as it must be, those of the verdict first.
std::vector<std::string> failures(const Findings& findings) {
  std::vector<std::string> sentences;
  if (findings.comparison.verdict.outcome == compare::Outcome::differ) sentences = findings.comparison.verdict.reasons;
  if (findings.baseline) {
    const auto add = [&](char side, const compare::Verdict& verdict) {
      for (const std::string& reason : verdict.reasons)
        sentences.push_back(fmt::format("Since '{}', {} has changed: {}", findings.baseline->folder, side, reason));
    };
    add('a', findings.baseline->a.verdict);
    add('b', findings.baseline->b.verdict);
  }
  return sentences;
}

/// The verdict of the exit code, and whose it is.
std::string overall_text(const Findings& findings) {
  std::vector<std::string> causes;
  const auto add = [&](const compare::Verdict& verdict, const char* what) {
    if (verdict.outcome != compare::Outcome::agree) causes.emplace_back(what);
  };
  add(findings.comparison.verdict, "a and b");
  add(findings.baseline->a.verdict, "a and its baseline");
  add(findings.baseline->b.verdict, "b and its baseline");
  const compare::Verdict overall{.outcome = outcome_of(findings), .reasons = {}};
  return causes.empty() ? compare::name(overall)
                        : fmt::format("{}: {}", compare::name(overall), fmt::join(causes, ", "));
}

std::string json_of(const Findings& findings) {
  nlohmann::ordered_json json = to_json(findings.comparison);
  if (findings.baseline) json["baseline"] = to_json(*findings.baseline);
  json["date"] = findings.date;
  json["command"] = findings.command;
  return json_text(json);
}

JunitCase junit_case(const Findings& findings) {
  const compare::Rendering& a = findings.comparison.a;
  const compare::Rendering& b = findings.comparison.b;
  return {.group = findings.comparison.job.scene,
          .name = fmt::format("{} against {}", a.device.name, b.device.name),
          .seconds = (a.milliseconds + b.milliseconds) / 1000,
          .failures = failures(findings),
          .error = {}};
}

/// What is to be written once the findings and the page are complete. It refers to both, so that files can be checked
/// before anything is rendered.
std::vector<OutputFile> output_files(const Options& options, const Findings& findings, const std::string& page,
                                     std::optional<compare::MetricSet> metrics) {
  const compare::Comparison& comparison = findings.comparison;
  std::vector<OutputFile> files;
  const auto add_text = [&](const std::filesystem::path& path, const auto& text) {
    files.push_back({path, [text](const std::filesystem::path& name) { write_text(name, text()); }});
  };
  const auto json = [&findings] { return json_of(findings); };
  if (!options.json.empty()) add_text(options.json, json);
  if (!options.junit.empty()) {
    add_text(options.junit, [&findings] { return junit_xml("tandem diff", std::vector{junit_case(findings)}); });
  }
  if (!options.report.empty()) {
    add_text(options.report / "index.html", [&page] { return page; });
  }
  if (options.folder.empty()) return files;
  const auto add = [&](const char* name, const auto& image, const auto& metadata, const pathtracer::Tone& tone) {
    files.push_back({options.folder / name, [=](const std::filesystem::path& path) {
                       pathtracer::write_image(path, image(), metadata(), tone);
                     }});
  };
  const auto add_rendering = [&](const char* name, const compare::Rendering& rendering) {
    add(
        name, [&rendering] { return rendering.image; }, [&rendering] { return rendering.metadata; }, options.tone);
  };
  const auto metadata = [&comparison] {
    pathtracer::ImageMetadata both = comparison.a.metadata;
    if (comparison.a.trace != comparison.b.trace) both.erase("trace");
    both["device"] = comparison.a.device.name + " minus " + comparison.b.device.name;
    return both;
  };
  const std::filesystem::path stored = options.folder / stored_report;
  if (options.json.empty() || !is_same_file(options.json, stored)) add_text(stored, json);
  add_rendering("a.exr", comparison.a);
  add_rendering("a.png", comparison.a);
  add_rendering("b.exr", comparison.b);
  add_rendering("b.png", comparison.b);
  add("difference.exr", [&comparison] { return compare::signed_difference(comparison.a.image, comparison.b.image); },
      metadata, {});
  if (options.comparison.comparison.classify)
    add("classes.png",
        [&comparison] {
          return compare::class_map(*comparison.classification, comparison.a.image, comparison.b.image);
        },
        metadata, {});
  add("difference.png", [&comparison] { return compare::heat_map(comparison.a.image, comparison.b.image); }, metadata,
      {});
  if (metrics == compare::MetricSet::all) {
    add("flip.png", [&comparison] { return compare::error_map(*comparison.detailed_metrics->flip); }, metadata, {});
  }
  return files;
}

int diff(const Options& options) {
  std::optional<StoredRun> baseline;
  if (!options.baseline.empty()) {
    if (!options.folder.empty() && is_same_file(options.folder, options.baseline))
      throw Error(fmt::format("--out and --baseline are both '{}': the baseline would be overwritten",
                              options.folder.string()));
    baseline = read_stored_run(options.baseline);
  }
  compare::Job job = load_job(options.render);
  compare::ComparisonOptions wanted = comparison_options(options.comparison, options.render);
  if (!options.report.empty()) wanted = with_metrics_for_page(wanted);
  compare::ComparedDevices devices = open_devices(options.comparison, options.render);
  std::optional<ShownStage> stage(building_stage);
  compare::Session session = prepare(std::move(devices), std::move(job), wanted);
  stage.reset();
  if (baseline) {
    if (wanted.thresholds.tier == compare::Tier::statistical)
      throw Error("--baseline cannot be combined with --tier statistical: its images have other samples");
    check_same_job(*baseline, session.summary, session.a.scene().camera(), session.a.scene().background());
  }
  Findings findings;
  std::string page;
  const std::vector<OutputFile> files = output_files(options, findings, page, wanted.metrics);
  const auto output_folder = [](const std::filesystem::path& path) {
    return path.empty() ? std::nullopt : std::make_optional<OutputFolder>(path);
  };
  const std::optional<OutputFolder> folder = output_folder(options.folder);
  const std::optional<OutputFolder> page_folder = output_folder(options.report);
  check_output_files(files);
  findings.date = date_text();
  findings.command = command_line();
  findings.comparison = compare_devices(session, progress_bars());
  if (baseline) findings.baseline = compare_with(*baseline, findings.comparison);
  print_warnings(findings.comparison.a.warnings);
  print("{}", table(findings.comparison));
  if (findings.baseline) print("\n{}{:<18}{}\n", table(*findings.baseline), "in all", overall_text(findings));
  if (!options.report.empty()) page = report_page(session, findings.comparison, json_of(findings));
  write_or_rescue(files);
  print_written(files);
  return exit_code_of(outcome_of(findings));
}

}  // namespace

void add_diff_command(CLI::App& app, Action& action) {
  CLI::App* const command =
      app.add_subcommand("diff", "Render a scene on two devices and compare the images pixel by pixel");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, options->render);
  add_device_pair(*command, options->comparison.a, options->comparison.b);
  command->add_option("--json", options->json, "Write all numbers and the verdict as JSON")->type_name("FILE");
  command->add_option("--junit", options->junit, "Write the verdict as JUnit XML, for CI")->type_name("FILE");
  command
      ->add_option(
          "--out", options->folder,
          "Write both images and their difference as .exr and .png, diff.json and, where measured, flip.png into "
          "this folder, which is created if missing")
      ->type_name("DIR");
  command
      ->add_option(
          "--report", options->report,
          "Write index.html, a page with images, numbers and paths, into this folder, which is created if missing; "
          "implies --metrics all unless --metrics is given")
      ->type_name("DIR");
  command
      ->add_option("--baseline", options->baseline,
                   "Compare also with an earlier run of the same scene and settings, stored in this folder by --out")
      ->type_name("DIR");
  add_comparison_options(*command, options->comparison);
  add_tone_options(*command, options->tone);
  command->footer(
      "A shader of your own or an Amber script in the place of SCENE: 'tandem diff x.comp --help'.\n"
      "Exit code: 0 the images agree, 1 they differ (from each other or from the baseline), 2 error, 3 they differ,\n"
      "but --classify explains it by the scene: no device is at fault.\n"
      "Examples:\n"
      "  tandem diff scenes/cornell_box.obj --a cpu --b vulkan\n"
      "  tandem diff scenes/cornell_box.obj --a vulkan:0 --b vulkan:1 --spp 64 --json diff.json --out diff\n"
      "  tandem diff scenes/foliage.obj --a cpu --trace-a query --b cpu --trace-b pipeline --min-bit-equal 1\n"
      "  tandem diff model.obj --a cpu --b vulkan --min-bit-equal 0.9999\n"
      "  tandem diff model.obj --a cpu --b vulkan --classify\n"
      "  tandem diff model.obj --a cpu --b vulkan --out today --baseline yesterday");
  command->callback([&action, options] { action = [options] { return diff(*options); }; });
}

}  // namespace tandem::tools
