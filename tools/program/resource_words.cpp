#include "tools/program/resource_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "program/data/table.hpp"

namespace tandem::tools::program_run {
namespace {

using program::ScalarType;
using rhi::TextureFormat;

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t end = 0; end != std::string_view::npos;) {
    end = text.find(separator);
    parts.emplace_back(text.substr(0, end));
    if (end != std::string_view::npos) text.remove_prefix(end + 1);
  }
  return parts;
}

template <typename Number>
std::optional<Number> number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool begins_a_number(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  return !text.empty() && ((text[0] >= '0' && text[0] <= '9') || text[0] == '.' || text == "nan" || text == "inf");
}

/// "1,2.5,-3": every word a number.
bool is_value_list(std::string_view text) {
  const std::vector<std::string> words = program::value_words(text);
  return !words.empty() && std::ranges::all_of(words, [](const std::string& word) { return begins_a_number(word); }) &&
         text.find('/') == std::string_view::npos;
}

/// "64B", "16KiB", "4MiB", "1GiB" as bytes.
std::optional<std::uint64_t> byte_count(std::string_view text) {
  constexpr std::pair<const char*, int> units[] = {{"KiB", 10}, {"MiB", 20}, {"GiB", 30}, {"B", 0}};
  for (const auto& [unit, shift] : units)
    if (text.ends_with(unit)) {
      text.remove_suffix(std::string_view(unit).size());
      const std::optional<std::uint64_t> count = number<std::uint64_t>(text);
      return count && *count < (std::uint64_t{1} << 40 >> shift) ? std::optional(*count << shift) : std::nullopt;
    }
  return std::nullopt;
}

std::optional<std::array<double, 2>> range_of(std::string_view text) {
  const std::size_t dots = text.find("..");
  if (dots == std::string_view::npos) return std::nullopt;
  const std::optional<double> least = number<double>(text.substr(0, dots));
  const std::optional<double> most = number<double>(text.substr(dots + 2));
  return least && most && *least <= *most ? std::optional(std::array{*least, *most}) : std::nullopt;
}

/// "float32", "f32", "vec3", "uint", "u8vec4".
std::optional<program::ValueType> type_named(std::string_view word) {
  for (int i = 0; i <= static_cast<int>(ScalarType::uint64); ++i) {
    const auto scalar = static_cast<ScalarType>(i);
    const std::string_view name = program::name_of(scalar);
    const std::string abbreviated = std::string(1, name[0]) + std::string(name.substr(name.find_first_of("123468")));
    if (word == name || word == abbreviated) return program::make_type(scalar);
    for (std::uint32_t rows = 1; rows <= 4; ++rows)
      if (program::ValueType type = program::make_type(scalar, rows); program::describe(type) == word) return type;
  }
  return std::nullopt;
}

/// Takes what it understands from the front of the parts.
Source take_source(const Setting& setting, std::vector<std::string>& parts) {
  const std::string first = parts.front();
  parts.erase(parts.begin());
  if (first == "zeros") return {.kind = SourceKind::zeros};
  if (first == "iota") return {.kind = SourceKind::iota};
  if (first == "random") {
    const std::optional<std::uint64_t> seed = parts.empty() ? std::nullopt : number<std::uint64_t>(parts.front());
    if (!seed) refuse(setting, "random needs a seed, as in random:1");
    parts.erase(parts.begin());
    Source source{.kind = SourceKind::random, .seed = *seed};
    const auto range = std::ranges::find_if(parts, [](const std::string& part) { return range_of(part).has_value(); });
    if (range != parts.end()) {
      source.range = range_of(*range);
      parts.erase(range);
    }
    return source;
  }
  std::error_code error;
  const bool is_file = std::filesystem::is_regular_file(setting.folder / first, error);
  if (!is_file && is_value_list(first)) return {.kind = SourceKind::values, .values = program::value_words(first)};
  return {.kind = SourceKind::file, .file = setting.folder / first};
}

/// The parts between colons; the name of a file may have some.
std::vector<std::string> parts_of(const Setting& setting) {
  std::error_code error;
  const bool is_file = std::filesystem::is_regular_file(setting.folder / setting.value, error);
  return is_file ? std::vector{setting.value} : split(setting.value, ':');
}

bool is_source_word(const std::string& part) { return part == "zeros" || part == "iota" || part == "random"; }

}  // namespace

void refuse(const Setting& setting, const std::string& sentence) {
  throw Error(fmt::format("{}: {}", setting.where, sentence));
}

std::optional<TextureFormat> format_named(std::string_view word) {
  for (std::size_t i = 0; i < rhi::texture_format_count; ++i) {
    const rhi::TextureFormatInfo& info = rhi::info_of(static_cast<TextureFormat>(i));
    const auto glsl_name = [&]() -> std::string {
      const std::string_view stem = info.name.substr(0, info.name.find('_'));
      if (info.name.ends_with("_unorm")) return std::string(stem);
      if (info.name.ends_with("_float")) return fmt::format("{}f", stem);
      if (info.name.ends_with("_uint")) return fmt::format("{}ui", stem);
      if (info.name.ends_with("_sint")) return fmt::format("{}i", stem);
      return std::string(info.name);
    };
    if (word == info.name || word == glsl_name()) return info.format;
  }
  return std::nullopt;
}

BufferWords buffer_words(const Setting& setting) {
  if (setting.value.empty()) refuse(setting, fmt::format("'{}' has no contents", setting.key));
  std::vector<std::string> parts = parts_of(setting);
  BufferWords words;
  words.source = take_source(setting, parts);
  for (const std::string& part : parts) {
    if (const auto elements = number<std::uint64_t>(part))
      words.elements = elements;
    else if (const auto bytes = byte_count(part))
      words.bytes = bytes;
    else if (const auto type = type_named(part))
      words.type = type;
    else if (const auto format = format_named(part))
      words.format = format;
    else
      refuse(setting, fmt::format("'{}' is no number of elements, no size such as 4MiB, and no type such as vec4",
                                  shortened(part)));
  }
  return words;
}

ImageWords image_words(const Setting& setting) {
  if (setting.value.empty()) refuse(setting, fmt::format("'{}' has no format, size or file", setting.key));
  std::vector<std::string> parts = parts_of(setting);
  ImageWords words;
  while (!parts.empty()) {
    const std::string part = parts.front();
    if (const auto format = format_named(part)) {
      words.format = format;
    } else if (part.starts_with("levels=") && number<std::uint32_t>(std::string_view(part).substr(7))) {
      words.levels = *number<std::uint32_t>(std::string_view(part).substr(7));
    } else if (!is_source_word(part) && begins_a_number(part) && part.find('.') == std::string::npos) {
      words.size = three_sizes({.where = setting.where, .key = setting.key, .value = part});
    } else {
      words.source = take_source(setting, parts);
      continue;
    }
    parts.erase(parts.begin());
  }
  return words;
}

rhi::SamplerDesc sampler_words(const Setting& setting) {
  using rhi::AddressMode;
  rhi::SamplerDesc sampler{.label = setting.key};
  const auto address = [&](AddressMode mode) { sampler.address = {mode, mode, mode}; };
  constexpr std::pair<const char*, rhi::CompareOp> compares[] = {{"never", rhi::CompareOp::never},
                                                                 {"less", rhi::CompareOp::less},
                                                                 {"equal", rhi::CompareOp::equal},
                                                                 {"less_or_equal", rhi::CompareOp::less_or_equal},
                                                                 {"greater", rhi::CompareOp::greater},
                                                                 {"not_equal", rhi::CompareOp::not_equal},
                                                                 {"greater_or_equal", rhi::CompareOp::greater_or_equal},
                                                                 {"always", rhi::CompareOp::always}};
  for (const std::string& word : split(setting.value, ',')) {
    const auto compare = std::ranges::find_if(compares, [&](const auto& each) { return word == each.first; });
    if (word == "linear") {
      sampler.magnification = sampler.minification = sampler.mipmap = rhi::Filter::linear;
    } else if (word == "nearest") {
      sampler.magnification = sampler.minification = sampler.mipmap = rhi::Filter::nearest;
    } else if (word == "repeat") {
      address(AddressMode::repeat);
    } else if (word == "mirror") {
      address(AddressMode::mirrored_repeat);
    } else if (word == "clamp") {
      address(AddressMode::clamp_to_edge);
    } else if (word == "border") {
      address(AddressMode::clamp_to_border);
    } else if (word == "unnormalized") {
      sampler.unnormalized_coordinates = true;
      sampler.max_lod = 0;
      address(AddressMode::clamp_to_edge);
    } else if (compare != std::end(compares)) {
      sampler.compare = compare->second;
    } else {
      refuse(setting, fmt::format("'{}' is none of linear, nearest, repeat, mirror, clamp, border, unnormalized, less, "
                                  "less_or_equal, greater and the other comparisons",
                                  shortened(word)));
    }
  }
  return sampler;
}

std::array<std::uint32_t, 3> three_sizes(const Setting& setting) {
  std::array<std::uint32_t, 3> sizes = {1, 1, 1};
  const std::vector<std::string> parts = split(setting.value, setting.value.find('x') == std::string::npos ? ',' : 'x');
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::optional<std::uint32_t> size = number<std::uint32_t>(parts[i]);
    if (i >= sizes.size() || !size || *size == 0)
      refuse(setting, fmt::format("'{}' is not one to three whole numbers from 1, such as 16,8,1 or 512x512",
                                  shortened(setting.value)));
    sizes[i] = *size;
  }
  return sizes;
}

}  // namespace tandem::tools::program_run
