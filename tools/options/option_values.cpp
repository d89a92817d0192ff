#include "tools/options/option_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

namespace tandem::tools {
namespace {

/// Any more would not leave room for three floats a pixel below 2^32 elements, which is how far a shader's index
/// counts.
constexpr std::uint64_t most_pixels = std::uint64_t{1} << 28;

/// The number that the whole of `text` spells, or none.
template <typename Number>
std::optional<Number> number(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc{} || result.ptr != end) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(value)) return std::nullopt;
  }
  return value;
}

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& expected) {
  throw CLI::ValidationError(option, fmt::format("'{}' is not {}", text, expected));
}

/// The parts of `text` between its separators, exactly `count` of them, or none.
template <std::size_t count>
std::optional<std::array<std::string_view, count>> split(std::string_view text, char separator) {
  std::array<std::string_view, count> parts;
  for (std::size_t index = 0; index < count; ++index) {
    const std::size_t end = text.find(separator);
    if ((end == std::string_view::npos) != (index + 1 == count)) return std::nullopt;
    parts[index] = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return parts;
}

template <typename Number, typename Value>
CLI::Option* add_in_range(CLI::App& command, const std::string& name, Value& value, Number least, Number most,
                          const std::string& kind, const std::string& type, const std::string& description) {
  const auto read = [&value, name, least, most, kind](const std::string& text) {
    const std::optional<Number> read_value = number<Number>(text);
    if (!read_value || *read_value < least || *read_value > most) {
      refuse(name, text, fmt::format("{} from {} to {}", kind, least, most));
    }
    value = *read_value;
  };
  return command.add_option_function<std::string>(name, read, description)->type_name(type);
}

}  // namespace

CLI::Option* add_whole_number(CLI::App& command, const std::string& name, std::uint64_t& value, std::uint64_t least,
                              std::uint64_t most, const std::string& description) {
  return add_in_range(command, name, value, least, most, "a whole number", "N", description)
      ->default_str(std::to_string(value));
}

CLI::Option* add_whole_number(CLI::App& command, const std::string& name, std::uint32_t& value, std::uint32_t least,
                              std::uint32_t most, const std::string& description) {
  return add_in_range(command, name, value, least, most, "a whole number", "N", description)
      ->default_str(std::to_string(value));
}

CLI::Option* add_number(CLI::App& command, const std::string& name, double& value, double least, double most,
                        const std::string& description) {
  return add_in_range(command, name, value, least, most, "a number", "X", description)
      ->default_str(fmt::format("{}", value));
}

CLI::Option* add_number(CLI::App& command, const std::string& name, std::optional<float>& value, float least,
                        float most, const std::string& type, const std::string& description) {
  return add_in_range(command, name, value, least, most, "a number", type, description);
}

CLI::Option* add_number(CLI::App& command, const std::string& name, std::optional<double>& value, double least,
                        double most, const std::string& description) {
  return add_in_range(command, name, value, least, most, "a number", "X", description);
}

CLI::Option* add_whole_number(CLI::App& command, const std::string& name, std::optional<std::uint32_t>& value,
                              std::uint32_t least, std::uint32_t most, const std::string& description) {
  return add_in_range(command, name, value, least, most, "a whole number", "N", description);
}

CLI::Option* add_choice(CLI::App& command, const std::string& name, std::span<const char* const> names,
                        const std::function<void(std::size_t)>& choose, const std::string& description) {
  const std::vector<std::string> texts(names.begin(), names.end());
  const auto read = [name, texts, choose](const std::string& text) {
    const auto found = std::ranges::find(texts, text);
    if (found == texts.end()) refuse(name, text, fmt::format("one of {}", fmt::join(texts, ", ")));
    choose(static_cast<std::size_t>(found - texts.begin()));
  };
  return command.add_option_function<std::string>(name, read, description)
      ->type_name(fmt::format("{}", fmt::join(texts, "|")));
}

CLI::Option* add_size(CLI::App& command, const std::string& name, std::optional<glm::uvec2>& value,
                      const std::string& description) {
  const auto read = [&value, name](const std::string& text) {
    const auto parts = split<2>(text, 'x');
    const std::optional<std::uint32_t> width = parts ? number<std::uint32_t>((*parts)[0]) : std::nullopt;
    const std::optional<std::uint32_t> height = parts ? number<std::uint32_t>((*parts)[1]) : std::nullopt;
    if (!width || !height || *width == 0 || *height == 0 || std::uint64_t{*width} * *height > most_pixels) {
      refuse(name, text, fmt::format("a size such as 512x512, at least 1x1 and at most {} pixels in all", most_pixels));
    }
    value = glm::uvec2(*width, *height);
  };
  return command.add_option_function<std::string>(name, read, description)->type_name("WxH");
}

CLI::Option* add_pixel(CLI::App& command, const std::string& name, glm::uvec2& value, const std::string& description) {
  const auto read = [&value, name](const std::string& text) {
    const auto parts = split<2>(text, ',');
    const std::optional<std::uint32_t> x = parts ? number<std::uint32_t>((*parts)[0]) : std::nullopt;
    const std::optional<std::uint32_t> y = parts ? number<std::uint32_t>((*parts)[1]) : std::nullopt;
    if (!x || !y) refuse(name, text, "a pixel such as 200,310");
    value = glm::uvec2(*x, *y);
  };
  return command.add_option_function<std::string>(name, read, description)->type_name("X,Y");
}

CLI::Option* add_vector(CLI::App& command, const std::string& name, std::optional<glm::vec3>& value, float least,
                        const std::string& type, const std::string& description) {
  const auto read = [&value, name, least](const std::string& text) {
    const bool any = least == std::numeric_limits<float>::lowest();
    const std::string expected = fmt::format("three numbers{} such as 0,1.5,2",
                                             any ? std::string() : fmt::format(" that are at least {}", least));
    const auto parts = split<3>(text, ',');
    if (!parts) refuse(name, text, expected);
    glm::vec3 vector(0.0F);
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<float> component = number<float>((*parts)[static_cast<std::size_t>(axis)]);
      if (!component || *component < least) refuse(name, text, expected);
      vector[axis] = *component;
    }
    value = vector;
  };
  return command.add_option_function<std::string>(name, read, description)->type_name(type);
}

CLI::Option* add_point(CLI::App& command, const std::string& name, std::optional<glm::dvec3>& value,
                       const std::string& description) {
  const auto read = [&value, name](const std::string& text) {
    constexpr const char* expected = "three numbers such as 0,1.5,2";
    const auto parts = split<3>(text, ',');
    if (!parts) refuse(name, text, expected);
    glm::dvec3 point(0);
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<double> component = number<double>((*parts)[static_cast<std::size_t>(axis)]);
      if (!component || !std::isfinite(static_cast<float>(*component))) refuse(name, text, expected);
      point[axis] = *component;
    }
    value = point;
  };
  return command.add_option_function<std::string>(name, read, description)->type_name("X,Y,Z");
}

}  // namespace tandem::tools
