#include "tools/options/option_words.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "devices/devices.hpp"

namespace tandem::tools {
namespace {

constexpr std::string_view device_option = "--device";
constexpr std::pair<std::string_view, std::string_view> old_names[] = {
    {"--samples", "--spp"}, {"--max-depth", "--depth"}, {"--light-sampling", "--nee"}, {"--vertical-fov", "--fov"}};

/// Whether a comma of the list has nothing on one of its sides.
bool has_empty_name(std::string_view list) {
  return list.empty() || list.front() == ',' || list.back() == ',' || list.find(",,") != std::string_view::npos;
}

}  // namespace

std::string_view current_name(std::string_view option) {
  const auto old = std::ranges::find(old_names, option, &std::pair<std::string_view, std::string_view>::first);
  return old == std::end(old_names) ? option : old->second;
}

std::vector<std::string> option_words(std::span<const char* const> arguments) {
  std::vector<std::string> words;
  bool follows_devices = false;  // the last word is the value of --device
  bool follows_option = false;   // the last word is --device
  for (const std::string_view argument : arguments) {
    if (follows_devices && is_device_name(argument)) {
      words.back().append(",").append(argument);
      continue;
    }
    const std::string_view name = argument.substr(0, argument.find('='));
    const std::string_view value =
        follows_option ? argument : argument.substr(std::min(name.size() + 1, argument.size()));
    const bool is_value = follows_option || (name == device_option && argument != device_option);
    if (is_value && has_empty_name(value))
      throw Error(
          fmt::format("{}: '{}' is not a device or a list of devices such as cpu,vulkan", device_option, value));
    words.emplace_back(current_name(name)).append(argument.substr(name.size()));
    follows_devices = is_value;
    follows_option = !follows_option && argument == device_option;
  }
  return words;
}

}  // namespace tandem::tools
