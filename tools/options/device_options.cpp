#include "tools/options/device_options.hpp"

#include <fmt/format.h>

namespace tandem::tools {
namespace {

constexpr const char* option = "--device";

}  // namespace

void add_device(CLI::App& command, std::string& device, const std::string& description, const std::string& otherwise) {
  const auto read = [&device, otherwise](const std::vector<std::string>& names) {
    if (names.size() != 1)
      throw CLI::ValidationError(option, fmt::format("one device is taken, not {}; {}", names.size(), otherwise));
    device = names.front();
  };
  command.add_option_function<std::vector<std::string>>(option, read, description)
      ->allow_extra_args(false)
      ->delimiter(',')
      ->type_name("D")
      ->default_str(device);
}

CLI::Option* add_devices(CLI::App& command, std::vector<std::string>& devices, const std::string& description) {
  return command.add_option(option, devices, description)
      ->allow_extra_args(false)
      ->delimiter(',')
      ->type_name("D,D,...");
}

void add_device_pair(CLI::App& command, std::string& a, std::string& b) {
  CLI::Option* const first =
      command.add_option("--a", a, "The first device, the reference")->type_name("D1")->capture_default_str();
  CLI::Option* const second = command.add_option("--b", b, "The second device")->type_name("D2")->capture_default_str();
  const auto read = [&a, &b](const std::vector<std::string>& names) {
    if (names.size() != 2)
      throw CLI::ValidationError(option, fmt::format("two devices are compared, not {}{}", names.size(),
                                                     names.size() > 2 ? "; 'tandem matrix' compares more" : ""));
    a = names[0];
    b = names[1];
  };
  command.add_option_function<std::vector<std::string>>(option, read, "Both devices, in place of --a and --b")
      ->allow_extra_args(false)
      ->delimiter(',')
      ->type_name("D1,D2")
      ->excludes(first)
      ->excludes(second);
}

}  // namespace tandem::tools
