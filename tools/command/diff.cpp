#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "compare/cause/class_map.hpp"
#include "compare/image/difference.hpp"
#include "compare/image/flip/flip.hpp"
#include "pathtracer/image/image_io.hpp"
#include "tools/command.hpp"
#include "tools/comparison.hpp"
#include "tools/output/junit.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/output_file.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/diff_report.hpp"
#include "tools/report/report_page.hpp"

namespace tandem::tools {
namespace {

struct Options {
  RenderOptions render;
  ComparisonOptions comparison;
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

JunitCase junit_case(const DiffReport& report) {
  return {.group = report.job.scene,
          .name = fmt::format("{} against {}", report.a.device.name, report.b.device.name),
          .seconds = (report.a.milliseconds + report.b.milliseconds) / 1000,
          .failures = failures(report),
          .error = {}};
}

/// What is written once the report and the page are complete; it refers to both.
std::vector<OutputFile> output_files(const Options& options, const DiffReport& report, const std::string& page) {
  std::vector<OutputFile> files;
  const auto add_text = [&](const std::filesystem::path& path, const auto& text) {
    files.push_back({path, [text](const std::filesystem::path& name) { write_text(name, text()); }});
  };
  const auto json = [&report] { return json_text(to_json(report)); };
  if (!options.json.empty()) add_text(options.json, json);
  if (!options.junit.empty()) {
    add_text(options.junit, [&report] { return junit_xml("tandem diff", std::vector{junit_case(report)}); });
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
  const auto add_rendering = [&](const char* name, const Rendering& rendering) {
    add(
        name, [&rendering] { return rendering.image; }, [&rendering] { return rendering.metadata; }, options.tone);
  };
  const auto metadata = [&report] {
    pathtracer::ImageMetadata both = report.a.metadata;
    if (report.a.trace != report.b.trace) both.erase("trace");
    both["device"] = report.a.device.name + " minus " + report.b.device.name;
    return both;
  };
  const std::filesystem::path stored = options.folder / stored_report;
  if (options.json.empty() || !is_same_file(options.json, stored)) add_text(stored, json);
  add_rendering("a.exr", report.a);
  add_rendering("a.png", report.a);
  add_rendering("b.exr", report.b);
  add_rendering("b.png", report.b);
  add("difference.exr", [&report] { return compare::signed_difference(report.a.image, report.b.image); }, metadata, {});
  if (options.comparison.classify)
    add("classes.png", [&report] { return compare::class_map(*report.classification, report.a.image, report.b.image); },
        metadata, {});
  add("difference.png", [&report] { return compare::heat_map(report.a.image, report.b.image); }, metadata, {});
  if (options.comparison.metrics == compare::MetricSet::all) {
    add("flip.png", [&report] { return compare::error_map(*report.detailed_metrics->flip); }, metadata, {});
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
  RenderJob job = load_job(options.render);
  const ComparisonOptions comparison_options =
      options.report.empty() ? options.comparison : with_metrics_for_page(options.comparison);
  Comparison comparison =
      prepare(comparison_options, options.render, std::move(job), open_devices(comparison_options, options.render));
  if (baseline) {
    if (comparison.thresholds.tier == compare::Tier::statistical)
      throw Error("--baseline cannot be combined with --tier statistical: its images have other samples");
    check_same_job(*baseline, comparison.summary, comparison.a.camera(), comparison.a.background());
  }
  DiffReport report;
  std::string page;
  const std::vector<OutputFile> files = output_files(options, report, page);
  const auto output_folder = [](const std::filesystem::path& path) {
    return path.empty() ? std::nullopt : std::make_optional<OutputFolder>(path);
  };
  const std::optional<OutputFolder> folder = output_folder(options.folder);
  const std::optional<OutputFolder> page_folder = output_folder(options.report);
  check_output_files(files);
  report = compare_devices(comparison);
  if (baseline) report.baseline = compare_with(*baseline, report);
  print_warnings(report.a.warnings);
  fmt::print("{}", table(report));
  if (!options.report.empty()) page = report_page(comparison, report);
  write_or_rescue(files);
  return failures(report).empty() ? exit_code::success : exit_code::differ;
}

}  // namespace

void add_diff_command(CLI::App& app, Action& action) {
  CLI::App* const command =
      app.add_subcommand("diff", "Render a scene on two devices and compare the images pixel by pixel");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, options->render);
  command->add_option("--a", options->comparison.a, "The first device, the reference")
      ->type_name("D1")
      ->capture_default_str();
  command->add_option("--b", options->comparison.b, "The second device")->type_name("D2")->capture_default_str();
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
      "Exit code: 0 the images agree, 1 they differ (from each other or from the baseline), 2 error.\n"
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
