#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "base/progress.hpp"
#include "devices/devices.hpp"
#include "program/amber/script_run.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/junit.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/program/printed_text.hpp"

namespace tandem::tools {
namespace {

namespace amber = program::amber;
using amber::Outcome;

struct Options {
  std::vector<std::filesystem::path> paths;
  std::vector<std::string> devices = {"cpu"};
  std::filesystem::path junit;    ///< empty: none
  std::uint32_t time_limit = 60;  ///< seconds; 0: none
  bool validation = false;
};

/// How often each outcome was on a device.
struct Counts {
  std::string device;
  std::array<std::size_t, 4> of = {};
};

std::string_view word_of(Outcome outcome) {
  constexpr std::array<std::string_view, 4> words = {"passed", "failed", "skipped", "error"};
  return words[static_cast<std::size_t>(outcome)];
}

/// The files, and the scripts in the folders below those that are folders, sorted.
std::vector<std::filesystem::path> scripts_of(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& path : paths) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(path, ignored)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
      if (entry.is_regular_file() && entry.path().extension() == ".amber") found.push_back(entry.path());
    if (found.empty()) throw Error(fmt::format("{}: the folder has no file .amber", path.string()));
    std::ranges::sort(found);
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

rhi::DeviceHandle device_of(const std::string& name, const Options& options) {
  rhi::DeviceDesc desc;
  desc.name = name;
  desc.driver_validation = options.validation;
  desc.on_message = print_message;
  desc.time_limit = std::chrono::seconds(options.time_limit);
  return create_device(desc);
}

amber::Result run_script(const std::optional<amber::Script>& script, const std::string& error, rhi::Device& device) {
  if (!script) return {Outcome::error, {error}};
  return amber::run(*script, device);
}

void print_result(const std::string& file, const std::string& device, const amber::Result& result) {
  for (const program::PrintedLines& lines : result.printed)
    print("{}", program_run::printed_text(lines, fmt::format("{:<8} {:<10} {} ", "printed", device, file)));
  const bool on_line = result.outcome == Outcome::skipped && !result.reasons.empty();
  print("{:<8} {:<10} {}{}\n", word_of(result.outcome), device, file,
        on_line ? ": " + printable(result.reasons.front()) : "");
  if (!on_line)
    for (const std::string& reason : result.reasons) print("         {}\n", printable(reason));
  std::fflush(stdout);
}

JunitCase junit_case(const std::string& file, const std::string& device, const amber::Result& result, double seconds) {
  JunitCase test = {.group = file, .name = device, .seconds = seconds, .failures = {}, .error = {}};
  if (result.outcome == Outcome::failed) test.failures = result.reasons;
  if (result.outcome == Outcome::error) test.error = result.reasons.front();
  if (result.outcome == Outcome::skipped) test.skipped = result.reasons.front();
  return test;
}

int exit_code_of(const std::vector<Counts>& counts) {
  const auto has = [&](Outcome outcome) {
    return std::ranges::any_of(counts,
                               [&](const Counts& each) { return each.of[static_cast<std::size_t>(outcome)] != 0; });
  };
  return has(Outcome::error) ? exit_code::error : has(Outcome::failed) ? exit_code::failed : exit_code::success;
}

int run_scripts(const Options& options) {
  const std::vector<std::filesystem::path> files = scripts_of(options.paths);
  if (!options.junit.empty()) check_output_path(options.junit);
  std::vector<rhi::DeviceHandle> devices;
  std::vector<Counts> counts;
  for (const std::string& name : options.devices) {
    devices.push_back(device_of(name, options));
    counts.push_back({.device = name});
  }
  std::vector<JunitCase> cases;
  for (const std::filesystem::path& file : files) {
    std::optional<amber::Script> script;
    std::string error;
    try {
      script = amber::read(file);
    } catch (const Error& wrong) {
      error = wrong.what();
    }
    for (std::size_t i = 0; i < devices.size(); ++i) {
      if (interrupted()) throw Cancelled();
      const auto start = std::chrono::steady_clock::now();
      const amber::Result result = run_script(script, error, *devices[i]);
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      ++counts[i].of[static_cast<std::size_t>(result.outcome)];
      print_result(file.string(), counts[i].device, result);
      cases.push_back(junit_case(file.string(), counts[i].device, result, seconds.count()));
    }
  }
  for (const Counts& each : counts)
    print("{}: {} scripts, {} passed, {} failed, {} skipped, {} with an error\n", each.device, files.size(), each.of[0],
          each.of[1], each.of[2], each.of[3]);
  if (!options.junit.empty()) {
    const std::vector<OutputFile> outputs = {
        {options.junit, [&](const std::filesystem::path& name) { write_text(name, junit_xml("amber", cases)); }}};
    write_or_rescue(outputs);
    print_written(outputs);
  }
  return exit_code_of(counts);
}

}  // namespace

void add_amber_command(CLI::App& app, Action& action) {
  CLI::App* const command = app.add_subcommand("amber", "Run Amber scripts: shaders with what is expected of them");
  const auto options = std::make_shared<Options>();
  command->add_option("FILE", options->paths, "Scripts, or folders that are searched for files .amber")
      ->type_name("FILE.amber")
      ->required();
  add_devices(*command, options->devices, "Devices to run every script on")->capture_default_str();
  command->add_option("--junit", options->junit, "Write the results as JUnit XML, for CI")->type_name("FILE");
  add_whole_number(*command, "--time-limit", options->time_limit, 0, 86400,
                   "CPU devices: seconds after which a command is stopped and the script fails; 0: none");
  command->add_flag("--validation", options->validation,
                    "Enable the Vulkan validation layers; their messages go to standard error");
  command->footer(
      "A script is skipped, with the reason, where the device lacks what it needs.\n"
      "Exit code: 0 every script passed or was skipped, 1 an expectation is not met or a device failed, 2 a script is\n"
      "wrong, or any other error.\n"
      "Examples:\n"
      "  tandem amber shadow.amber --device cpu,vulkan\n"
      "  tandem amber tests/amber --device vulkan --junit amber.xml");
  command->callback([&action, options] { action = [options] { return run_scripts(*options); }; });
}

}  // namespace tandem::tools
