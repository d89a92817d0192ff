#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/atomic_file.hpp"
#include "pathtracer/image/image_codec.hpp"
#include "program/execute/execution.hpp"
#include "program/explain/explanation.hpp"
#include "program/explain/source.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/junit.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/program/explained_job.hpp"
#include "tools/program/explanation_json.hpp"
#include "tools/program/program_page.hpp"
#include "tools/program/results.hpp"
#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

using namespace program_run;

struct Options {
  RunArguments run;
  std::string a = "cpu", b = "vulkan", arbiter = "cpu-exact";
  std::filesystem::path json, junit;     ///< empty: none
  std::filesystem::path report, folder;  ///< likewise; folders
};

Contents contents_of(rhi::Device& device, const BuiltJob& built) {
  program::Execution execution(device, built.job);
  execution.run();
  Contents contents;
  for (const Resource& resource : built.resources)
    contents.push_back(resource.is_image ? execution.image(resource.index) : execution.buffer(resource.index));
  return contents;
}

/// A line for each instruction that differs in lockstep.
std::string instructions_text(const program::Explanation& explanation) {
  std::string text;
  for (const program::Site& site : explanation.lockstep.sites) {
    const program::SourcePlace place = program::source_of(site.shader->module, site.instruction);
    text += fmt::format("  {}:{}  {}: {}\n", place.file.empty() ? site.shader->name : place.file, place.line,
                        program::describe_instruction(site.shader->module, site.instruction),
                        program::name_of(site.example.judgement.cause));
  }
  return text;
}

/// A file name of a resource's.
std::string file_name(const std::string& key) {
  std::string name = key;
  for (char& letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '.' && letter != '-') letter = '_';
  return name;
}

/// The pictures of a comparison in a folder: those that there are when the files are written.
std::vector<OutputFile> picture_files(const std::filesystem::path& folder, const BuiltJob& built,
                                      const std::vector<ResourceComparison>& comparisons,
                                      const std::vector<ResourcePictures>& pictures) {
  std::vector<OutputFile> files;
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    const std::string name = file_name(built.resources[comparisons[i].resource].key);
    const auto add = [&](const char* what, const std::vector<std::byte>& png) {
      if (png.empty()) return;
      files.push_back({folder / fmt::format("{}_{}.png", name, what), [&png](const std::filesystem::path& path) {
                         AtomicFile file(path);
                         file.write(png);
                         file.commit();
                       }});
    };
    add("a", pictures[i].a);
    add("b", pictures[i].b);
    add("difference", pictures[i].difference);
  }
  return files;
}

int diff_program(const Options& options) {
  std::vector<OutputFile> files;
  std::string json, junit, page;
  const auto output_folder = [](const std::filesystem::path& path) {
    return path.empty() ? std::nullopt : std::make_optional<OutputFolder>(path);
  };
  const std::optional<OutputFolder> folder = output_folder(options.folder), report = output_folder(options.report);
  const bool has_pictures = folder || report;
  if (has_pictures) pathtracer::require_image_codec();
  if (report)
    files.push_back(
        {options.report / "index.html", [&](const std::filesystem::path& path) { write_text(path, page); }});
  if (folder)
    files.push_back({options.folder / "diff.json", [&](const std::filesystem::path& path) { write_text(path, json); }});
  if (!options.json.empty())
    files.push_back({options.json, [&](const std::filesystem::path& path) { write_text(path, json); }});
  if (!options.junit.empty())
    files.push_back({options.junit, [&](const std::filesystem::path& path) { write_text(path, junit); }});
  check_output_files(files);
  const RunOptions& run = options.run.run;
  const rhi::DeviceHandle a = open_device(options.a, run), b = open_device(options.b, run);
  const ExplainedJob explained = explained_job(options.run, a->info());
  const program::Tolerance tolerance = {run.tolerance.ulp, options.run.relative};

  std::optional<ShownStage> stage("running on both devices");
  const Contents of_a = contents_of(*a, explained.built), of_b = contents_of(*b, explained.built);
  stage.reset();
  const std::vector<ResourceComparison> comparisons = compared(explained.built, of_a, of_b, tolerance);
  const bool bit_equal = of_a == of_b;
  const bool agrees = std::ranges::all_of(comparisons, [](const auto& each) { return each.values.agrees(); });
  print("{}: {} against {}\n{}", explained.name, a->info().name, b->info().name,
        text_of(explained.built, comparisons, tolerance));

  std::string verdict = bit_equal ? "equal bits" : "equal within the tolerance";
  int code = exit_code::success;
  nlohmann::ordered_json explanation_json;
  std::optional<program::Explanation> explanation;
  if (!agrees) {
    const auto recording = [&](const std::string& name, const rhi::DeviceHandle& device) {
      return device->info().backend == "cpu" ? open_recording_device(name, run) : device;
    };
    const rhi::DeviceHandle recorded_a = recording(options.a, a), recorded_b = recording(options.b, b);
    rhi::DeviceHandle exact;
    if (!explained.built.job.top_levels.empty()) exact = open_device(options.arbiter, run);
    program::ExplainOptions wanted;
    wanted.exact = exact.get();
    stage.emplace("explaining the differences");
    explanation = program::explain(*recorded_a, *recorded_b, explained.built.job, wanted);
    stage.reset();
    const program::Cause cause = program::gravest(*explanation);
    const bool is_wrong = cause == program::Cause::mismatch;
    verdict =
        is_wrong ? "a mismatch: one of the devices is wrong" : fmt::format("explained: {}", program::name_of(cause));
    code = is_wrong ? exit_code::differ : exit_code::explained;
    print("{}", instructions_text(*explanation));
    explanation_json =
        to_json(*explanation, explained.built.job, {.a = a->info().name, .b = b->info().name, .input = explained.name});
  }
  print("verdict: {}\n", verdict);

  nlohmann::ordered_json resources = nlohmann::ordered_json::array();
  std::vector<JunitCase> cases;
  for (const ResourceComparison& each : comparisons) {
    const Resource& resource = explained.built.resources[each.resource];
    resources.push_back({{"name", resource.key},
                         {"values", each.values.scalars},
                         {"bit_equal", each.values.bit_equal},
                         {"within", each.values.within},
                         {"largest_ulp", each.values.largest_ulp}});
    JunitCase test{.group = explained.name, .name = resource.key, .failures = {}, .error = {}};
    if (!each.values.agrees() && code == exit_code::differ) test.failures = {verdict};
    cases.push_back(std::move(test));
  }
  nlohmann::ordered_json numbers = {{"format", json_format}, {"input", explained.name}, {"a", a->info().name},
                                    {"b", b->info().name},   {"verdict", verdict},      {"exit_code", code},
                                    {"resources", resources}};
  if (!explanation_json.is_null()) numbers["explanation"] = explanation_json;
  json = json_text(numbers);
  std::vector<ResourcePictures> pictures;
  if (has_pictures)
    for (const ResourceComparison& each : comparisons)
      pictures.push_back(pictures_of(explained.built, each.resource, of_a, of_b));
  if (report)
    page = program_page({.input = explained.name,
                         .verdict = verdict,
                         .agrees = agrees,
                         .is_wrong = code == exit_code::differ,
                         .a = a->info(),
                         .b = b->info(),
                         .built = explained.built,
                         .comparisons = comparisons,
                         .pictures = pictures,
                         .tolerance = tolerance,
                         .explanation = explanation ? &*explanation : nullptr});
  if (folder)
    for (OutputFile& file : picture_files(options.folder, explained.built, comparisons, pictures))
      files.push_back(std::move(file));
  junit = junit_xml("diff", cases);
  write_or_rescue(files);
  print_written(files);
  return code;
}

}  // namespace

void add_program_diff_command(CLI::App& app, Action& action) {
  CLI::App* const command =
      app.add_subcommand("diff", "Run a shader or an Amber script on two devices, and judge what differs");
  const auto options = std::make_shared<Options>();
  add_run_arguments(*command, options->run);
  add_device_pair(*command, options->a, options->b);
  command->add_option("--arbiter", options->arbiter, "Device that decides which of two ray hits is right")
      ->type_name("D3")
      ->capture_default_str();
  add_whole_number(*command, "--ulp", options->run.run.tolerance.ulp, 0, 1u << 31,
                   "Units in the last place by which two numbers may differ; of whole numbers their difference");
  add_number(*command, "--tolerance", options->run.relative, 0, 1, "Relative difference that is accepted as well");
  command->add_option("--json", options->json, "Write the comparison, and why it differs, as JSON")->type_name("FILE");
  command->add_option("--junit", options->junit, "Write a case for each buffer and image as JUnit XML")
      ->type_name("FILE");
  command
      ->add_option("--out", options->folder,
                   "Write every image of both devices, and where it or a buffer differs, as .png, and diff.json into "
                   "this folder, which is created if missing")
      ->type_name("DIR");
  command
      ->add_option(
          "--report", options->report,
          "Write index.html, a page with the verdict, numbers, pictures and the explanation, into this folder, "
          "which is created if missing")
      ->type_name("DIR");
  add_whole_number(*command, "--threads", options->run.run.threads, 0, 1024,
                   "Worker threads of the CPU devices; 0: one per hardware thread");
  command->add_flag("--validation", options->run.run.validation,
                    "Enable the Vulkan validation layers; their messages go to standard error");
  command->footer(
      "SHADER may also be one Amber script (FILE.amber); 'tandem explain' says more of the differences.\n"
      "Exit code: 0 equal within the tolerance, 1 a mismatch: one of the devices is wrong, 2 error, 3 they differ for\n"
      "reasons that both may have: precision, ties, the order of invocations.\n"
      "Examples:\n"
      "  tandem diff scale.comp --buffer values=iota:1024 --push factor=2 --groups 16 --a cpu --b vulkan\n"
      "  tandem diff shadow.amber --json diff.json --report report");
  command->callback([&action, options] { action = [options] { return diff_program(*options); }; });
}

}  // namespace tandem::tools
