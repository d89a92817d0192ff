#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "tools/command.hpp"
#include "tools/options/option_values.hpp"
#include "tools/options/shipped_file.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/junit.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/report/device_json.hpp"
#include "tools/suite/suite.hpp"
#include "tools/suite/suite_page.hpp"
#include "tools/suite/suite_run.hpp"

namespace tandem::tools {
namespace {

struct Options {
  std::filesystem::path file = shipped_scene("suite.json");
  std::filesystem::path folder = "suite";
  std::filesystem::path json;   ///< empty: that of the folder only
  std::filesystem::path junit;  ///< empty: none
  bool fresh = false;
  RenderOptions execution;  ///< threads and validation
};

void print_line(const SuiteResult& result) {
  const nlohmann::ordered_json& json = result.json;
  const std::string share =
      result.failed() ? std::string()
                      : fmt::format("{:.4f} % bit-equal  ", 100 * json.at("report").at("bit_equal").get<double>());
  print("{:<52}{}{}{}\n", json.at("name").get<std::string>(), share, json.at("state").get<std::string>(),
        result.reused ? " (reused)" : "");
  for (const std::string reason : json.at("reasons")) print("{:<52}{}\n", "", reason);
  std::fflush(stdout);
}

int run_suite(const Options& options) {
  const Suite suite = read_suite(options.file, options.execution);
  std::vector<SuiteResult> results;
  const OutputFolder folder(options.folder);
  const OutputFolder cells_folder(options.folder / suite_cells_folder);
  std::vector<OutputFile> files;
  const auto add_file = [&](const std::filesystem::path& path, const auto& text) {
    files.push_back({path, [text](const std::filesystem::path& name) { write_text(name, text()); }});
  };
  const auto json = [&results] { return json_text(to_json(results)); };
  add_file(folder.path() / "index.html", [&] { return suite_page(suite.title, results, folder.path()); });
  add_file(folder.path() / "suite.json", json);
  if (!options.json.empty()) add_file(options.json, json);
  if (!options.junit.empty()) add_file(options.junit, [&] { return junit_xml(suite.title, junit_cases(results)); });
  check_output_files(files);

  SuiteRun run(options.folder, options.fresh);
  for (const SuiteCell& cell : suite.cells) {
    try {
      if (interrupted()) throw Cancelled();
      results.push_back(run.run(cell));
    } catch (const Cancelled&) {
      throw Cancelled(fmt::format("interrupted after {} of {} comparisons; the same command continues from there",
                                  results.size(), suite.cells.size()));
    }
    print_line(results.back());
  }
  const nlohmann::ordered_json totals = to_json(results);
  const auto reused = std::ranges::count_if(results, [](const SuiteResult& each) { return each.reused; });
  print("{} comparisons: {} agree, {} are explained, {} differ, {} failed; {} were reused from an earlier run\n",
        results.size(), totals.at("agree").get<int>(), totals.at("explained").get<int>(),
        totals.at("differ").get<int>(), totals.at("failed").get<int>(), reused);
  write_or_rescue(files);
  print_written(files);
  return exit_code_of(outcome_of(results));
}

}  // namespace

void add_suite_command(CLI::App& app, Action& action) {
  CLI::App* const command =
      app.add_subcommand("suite", "Compare pairs of devices on many scenes and settings, in one page");
  const auto options = std::make_shared<Options>();
  command->add_option("FILE", options->file, "The suite: scenes, devices and settings")
      ->type_name("FILE.json")
      ->capture_default_str();
  command
      ->add_option(
          "--out", options->folder,
          "Folder for index.html, suite.json and the result of each comparison; results that it already holds are "
          "reused if scene, settings, devices, drivers and this program are unchanged")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_flag("--fresh", options->fresh, "Ignore results of earlier runs");
  command->add_option("--json", options->json, "Write suite.json to this file as well")->type_name("FILE");
  command->add_option("--junit", options->junit, "Write the verdicts as JUnit XML, for CI")->type_name("FILE");
  add_whole_number(*command, "--threads", options->execution.threads, 0, 1024,
                   "Worker threads of the CPU devices; 0: one per hardware thread");
  command->add_flag("--validation", options->execution.validation,
                    "Enable the Vulkan validation layers; their messages go to standard error");
  command->footer(
      "Exit code: 0 all agree, 1 a comparison differs or failed, 2 error, 3 some differ, but for reasons that the "
      "scene\n"
      "owns, 130 interrupted: run it again to continue.\n"
      "Examples:\n"
      "  tandem suite scenes/suite.json --out suite\n"
      "  tandem suite nightly.json --out nightly --junit nightly.xml");
  command->callback([&action, options] { action = [options] { return run_suite(*options); }; });
}

}  // namespace tandem::tools
