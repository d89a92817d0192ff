#include "tools/options/option_words.hpp"

#include <algorithm>
#include <utility>

#include "devices/devices.hpp"

namespace tandem::tools {
namespace {

constexpr std::string_view device_option = "--device";
constexpr std::pair<std::string_view, std::string_view> old_names[] = {
    {"--samples", "--spp"}, {"--max-depth", "--depth"}, {"--light-sampling", "--nee"}, {"--vertical-fov", "--fov"}};

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
    words.emplace_back(current_name(name)).append(argument.substr(name.size()));
    follows_devices = follows_option || (name == device_option && argument != device_option);
    follows_option = !follows_option && argument == device_option;
  }
  return words;
}

}  // namespace tandem::tools
