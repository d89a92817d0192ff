#include "pathtracer/load/obj/mtl_map.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace tandem::pathtracer {
namespace {

/// The numbers that `text` begins with, at most `count`; it is shortened by them.
std::vector<float> take_numbers(std::string_view& text, std::size_t count) {
  std::vector<float> numbers;
  double value = 0;
  for (std::string_view after = text; numbers.size() < count && parse_number(take_word(after), value); text = after)
    numbers.push_back(static_cast<float>(value));
  return numbers;
}

std::optional<std::uint32_t> channel_of(std::string_view name) {
  constexpr std::string_view names = "rgbml";  // m: matte, which is alpha
  const std::size_t index = names.find(name);
  if (name.size() != 1 || index == std::string_view::npos) return {};
  return static_cast<std::uint32_t>(index);
}
static_assert(luminance_channel == 4);

/// Reads an option whose name has been taken. Returns whether it has its effect.
bool read_option(MtlMap& map, std::string_view option, std::string_view& rest, const WavefrontText& text) {
  const bool is_vector = option == "-o" || option == "-s" || option == "-t";
  if (is_vector || option == "-mm" || option == "-bm") {
    const std::size_t most = is_vector ? 3 : option == "-mm" ? 2 : 1;
    std::vector<float> numbers = take_numbers(rest, most);
    const auto is_finite = [](float number) { return std::isfinite(number); };
    if (numbers.empty() || !std::ranges::all_of(numbers, is_finite) || (option == "-mm" && numbers.size() < 2))
      throw text.error(fmt::format("{} lacks its numbers", option));
    if (option == "-bm") map.multiplier = numbers[0];
    if (option == "-s") {
      map.texture.u_row.x = numbers[0];
      if (numbers.size() > 1) map.texture.v_row.y = numbers[1];
    }
    if (option == "-o") {
      map.texture.u_row.z = numbers[0];
      if (numbers.size() > 1) map.texture.v_row.z = numbers[1];
    }
    if (option == "-mm") map.texture.color_a = glm::vec3(map.texture.alpha_a = numbers[1]);
    // Of -mm only the factor.
    return option == "-mm" ? numbers[0] == 0 : option != "-t";
  }
  const std::string_view word = take_word(rest);
  if (option == "-clamp") {
    const auto clamp = static_cast<std::uint32_t>(TextureAddress::clamp);
    if (word == "on") map.texture.address = clamp | clamp << 8;
    return true;
  }
  if (option == "-imfchan") map.channel = channel_of(word);
  return option == "-imfchan" && map.channel.has_value();
}

}  // namespace

MtlMap parse_mtl_map(const WavefrontText& text, const Statement& statement, std::set<std::string>& ignored) {
  MtlMap map;
  std::string_view rest = statement.rest;
  while (rest.starts_with('-')) {
    const std::string_view option = take_word(rest);
    if (!read_option(map, option, rest, text)) ignored.emplace(option);
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
  }
  if (rest.empty()) throw text.error(fmt::format("{} names no file", statement.keyword));
  std::string name(rest);
  std::ranges::replace(name, '\\', '/');
  map.file = name;
  return map;
}

}  // namespace tandem::pathtracer
