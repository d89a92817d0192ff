#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "conformance/kit/report.hpp"
#include "devices/devices.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

struct Options {
  std::vector<std::string> devices;   ///< none: all that there are
  std::vector<std::string> required;  ///< "vulkan" stands for any "vulkan:N"
  std::string filter = "*";
  bool list = false;
  bool full = false;
  bool validation = false;
  std::filesystem::path json;      ///< empty: none
  std::filesystem::path markdown;  ///< empty: none
};

constexpr std::uint64_t full_watertightness_rays = 10'000'000;

std::vector<conformance::Case> chosen_cases(const std::string& filter) {
  std::vector<conformance::Case> cases = conformance::all_cases();
  std::erase_if(cases,
                [&](const conformance::Case& test) { return fnmatch(filter.c_str(), test.name.c_str(), 0) != 0; });
  if (cases.empty())
    throw std::invalid_argument(
        fmt::format("--filter: no case matches '{}'; 'tandem conformance --list' names them", filter));
  return cases;
}

/// What a device has to complain about, from any thread.
class Messages {
 public:
  void add(const rhi::Message& message) {
    print_message(message);
    if (message.severity == rhi::Severity::info) return;
    const std::lock_guard lock(mutex_);
    texts_.push_back(message.source + ": " + message.text);
  }
  std::vector<std::string> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(texts_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> texts_;
};

conformance::DeviceReport run_on(const std::string& name, const std::vector<conformance::Case>& cases,
                                 const Options& options) {
  // The device may speak while it is destroyed.
  const auto messages = std::make_shared<Messages>();
  rhi::DeviceDesc desc;
  desc.name = name;
  desc.driver_validation = options.validation;
  desc.on_message = [messages](const rhi::Message& message) { messages->add(message); };
  const rhi::DeviceHandle device = create_device(desc);
  conformance::RunOptions run_options = {.driver_bugs = conformance::known_driver_bugs()};
  if (options.full) run_options.settings.watertightness_rays = full_watertightness_rays;
  if (options.validation) run_options.take_messages = [messages] { return messages->take(); };
  run_options.on_result = [](const conformance::Result&) {
    if (interrupted()) throw Cancelled();
  };
  return conformance::run(*device, cases, run_options);
}

bool is_named(const rhi::DeviceInfo& device, const std::string& name) {
  return device.name == name || device.name.starts_with(name + ":");
}

int run_kit(const Options& options) {
  const std::vector<conformance::Case> cases = chosen_cases(options.filter);
  if (options.list) {
    for (const conformance::Case& test : cases) print("{}\n    {}\n", test.name, test.behaviour);
    return exit_code::success;
  }
  for (const std::filesystem::path& path : {options.json, options.markdown})
    if (!path.empty()) check_output_path(path);
  std::vector<std::string> names = options.devices;
  if (names.empty())
    for (const rhi::DeviceInfo& device : enumerate_devices(print_message)) names.push_back(device.name);

  std::vector<conformance::DeviceReport> reports;
  for (const std::string& name : names) {
    reports.push_back(run_on(name, cases, options));
    print("{}\n", conformance::text(reports.back()));
  }
  bool good = std::all_of(reports.begin(), reports.end(), conformance::succeeded);
  for (const std::string& required : options.required) {
    if (std::any_of(reports.begin(), reports.end(),
                    [&](const conformance::DeviceReport& report) { return is_named(report.device, required); }))
      continue;
    print("the required device '{}' is absent\n", required);
    good = false;
  }
  std::vector<OutputFile> files;
  const auto add_file = [&](const std::filesystem::path& path, const auto& text) {
    if (!path.empty()) files.push_back({path, [text](const std::filesystem::path& name) { write_text(name, text()); }});
  };
  add_file(options.json, [&] { return json_text(conformance::to_json(reports)); });
  add_file(options.markdown, [&] { return conformance::markdown(reports, cases, conformance::known_driver_bugs()); });
  write_or_rescue(files);
  print_written(files);
  return good ? exit_code::success : exit_code::failed;
}

}  // namespace

void add_conformance_command(CLI::App& app, Action& action) {
  CLI::App* const command = app.add_subcommand(
      "conformance", "Check what a device does with shaders, images and rays, one case per behaviour");
  const auto options = std::make_shared<Options>();
  add_devices(*command, options->devices, "Devices to check [all]");
  command
      ->add_option("--require-devices", options->required,
                   "Comma-separated devices without which the run fails; 'vulkan' is any Vulkan device")
      ->type_name("D,D")
      ->delimiter(',');
  command->add_option("--filter", options->filter, "Run only cases whose name matches, such as 'ray_query.*'")
      ->type_name("GLOB")
      ->capture_default_str();
  command->add_flag("--list", options->list, "List the cases with a description of each and exit");
  command->add_flag("--full", options->full, "Test watertightness with ten million rays in place of half a million");
  command->add_flag("--validation", options->validation,
                    "Vulkan: fail a case when the Khronos validation layer reports an error");
  command->add_option("--json", options->json, "Write all results as JSON")->type_name("FILE");
  command->add_option("--markdown", options->markdown, "Write the report as Markdown (docs/results/backend-status.md)")
      ->type_name("FILE");
  command->footer(
      "Exit code: 0 every case passed, is unsupported or fails by a known driver bug; 1 a case failed, a required\n"
      "device is absent or no case passed on a device; 2 error.\n"
      "Examples:\n"
      "  tandem conformance --device vulkan\n"
      "  tandem conformance --require-devices cpu,vulkan --full --markdown status.md\n"
      "  tandem conformance --device cpu --filter 'ray_query.builtin.*'");
  command->callback([&action, options] { action = [options] { return run_kit(*options); }; });
}

}  // namespace tandem::tools
