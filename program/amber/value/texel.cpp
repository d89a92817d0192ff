#include "program/amber/value/texel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/srgb.hpp"
#include "program/amber/value/number.hpp"

namespace tandem::program::amber {
namespace {

struct EncodingName {
  std::string_view name;
  Encoding encoding;
};
constexpr std::array<EncodingName, 9> encoding_names = {{{"UNORM", Encoding::unorm},
                                                         {"SNORM", Encoding::snorm},
                                                         {"UINT", Encoding::uint},
                                                         {"SINT", Encoding::sint},
                                                         {"USCALED", Encoding::uscaled},
                                                         {"SSCALED", Encoding::sscaled},
                                                         {"SRGB", Encoding::srgb},
                                                         {"SFLOAT", Encoding::sfloat},
                                                         {"UFLOAT", Encoding::ufloat}}};

const EncodingName* encoding_of(std::string_view name) {
  const auto* found =
      std::find_if(encoding_names.begin(), encoding_names.end(), [&](const auto& each) { return each.name == name; });
  return found == encoding_names.end() ? nullptr : found;
}

/// "R8G8B8A8": letters with their bits. False when it is something else.
bool parse_components(std::string_view text, std::vector<Component>& components) {
  while (!text.empty()) {
    Component component;
    component.name = text.front();
    if (std::string_view("RGBADSX").find(component.name) == std::string_view::npos) return false;
    text.remove_prefix(1);
    std::size_t digits = 0;
    component.bits = 0;
    while (digits < text.size() && digits < 2 && text[digits] >= '0' && text[digits] <= '9')
      component.bits = component.bits * 10 + static_cast<std::uint32_t>(text[digits++] - '0');
    if (component.bits == 0 || component.bits > 64) return false;
    text.remove_prefix(digits);
    components.push_back(component);
  }
  return true;
}

/// What the rhi calls a format of these components: it writes the names as Vulkan does, in lower case, each width once.
std::string rhi_name(const Texel& texel) {
  std::vector<Component> components = texel.components;
  // The rhi lists the lowest bits first, a packed name the highest.
  if (texel.packed) std::reverse(components.begin(), components.end());
  const std::uint32_t bits = components.front().bits;
  const bool same = std::all_of(components.begin(), components.end(), [&](const auto& c) { return c.bits == bits; });
  const char* suffix = "";
  switch (components.front().encoding) {
    case Encoding::unorm:
      suffix = "unorm";
      break;
    case Encoding::snorm:
      suffix = "snorm";
      break;
    case Encoding::uint:
      suffix = "uint";
      break;
    case Encoding::sint:
      suffix = "sint";
      break;
    case Encoding::srgb:
      suffix = "srgb";
      break;
    case Encoding::sfloat:
    case Encoding::ufloat:
      suffix = "float";
      break;
    case Encoding::uscaled:
    case Encoding::sscaled:
      return "";
  }
  std::string name;
  for (std::size_t i = 0; i < components.size(); ++i) {
    name += static_cast<char>(components[i].name - 'A' + 'a');
    const bool ends_run = i + 1 == components.size() || components[i + 1].bits != components[i].bits;
    if (same ? i + 1 == components.size() : ends_run) name += std::to_string(components[i].bits);
  }
  return name + "_" + suffix;
}

std::optional<rhi::TextureFormat> rhi_format(const Texel& texel) {
  const std::string name = rhi_name(texel);
  for (std::size_t i = 0; i < rhi::texture_format_count; ++i) {
    const rhi::TextureFormatInfo& info = rhi::info_of(static_cast<rhi::TextureFormat>(i));
    if (info.name == name && info.size == texel.size) return info.format;
  }
  return std::nullopt;
}

std::optional<ScalarType> scalar_of(Encoding encoding, std::uint32_t bits) {
  if (encoding == Encoding::sfloat || encoding == Encoding::ufloat) {
    if (bits == 16) return ScalarType::float16;
    if (bits == 32) return ScalarType::float32;
    if (bits == 64) return ScalarType::float64;
    return std::nullopt;
  }
  const bool is_signed = encoding == Encoding::sint || encoding == Encoding::snorm || encoding == Encoding::sscaled;
  switch (bits) {
    case 8:
      return is_signed ? ScalarType::int8 : ScalarType::uint8;
    case 16:
      return is_signed ? ScalarType::int16 : ScalarType::uint16;
    case 32:
      return is_signed ? ScalarType::int32 : ScalarType::uint32;
    case 64:
      return is_signed ? ScalarType::int64 : ScalarType::uint64;
    default:
      return std::nullopt;
  }
}

/// A float without a sign, with five bits of exponent: those of 10 and 11 bits.
double small_float(std::uint64_t bits, std::uint32_t width) {
  return from_half(static_cast<std::uint16_t>(bits << (15 - width)));
}

}  // namespace

std::optional<Texel> parse_texel(std::string_view name) {
  Texel texel;
  texel.name = std::string(name);
  std::vector<std::string_view> parts;
  for (std::string_view rest = name;;) {
    const std::size_t end = rest.find('_');
    parts.push_back(rest.substr(0, end));
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  if (parts.back().starts_with("PACK")) {
    texel.packed = true;
    parts.pop_back();
  }
  // Names such as D24_UNORM_S8_UINT have an encoding for each group of components, X8_D24_UNORM one for two groups.
  std::size_t without_encoding = 0;
  for (const std::string_view part : parts) {
    if (const EncodingName* encoding = encoding_of(part)) {
      for (; without_encoding < texel.components.size(); ++without_encoding)
        texel.components[without_encoding].encoding = encoding->encoding;
    } else if (!parse_components(part, texel.components)) {
      return std::nullopt;
    }
  }
  if (texel.components.empty() || without_encoding != texel.components.size()) return std::nullopt;
  std::uint32_t bits = 0;
  for (const Component& component : texel.components) bits += component.bits;
  std::uint32_t offset = texel.packed ? bits : 0;
  for (Component& component : texel.components) {
    component.offset = texel.packed ? offset -= component.bits : offset;
    if (!texel.packed) offset += component.bits;
  }
  if (bits % 8 != 0 || bits > 256 || (texel.packed && bits > 32)) return std::nullopt;
  const bool has_unequal = std::any_of(texel.components.begin(), texel.components.end(),
                                       [&](const Component& c) { return c.bits != texel.components.front().bits; });
  if (!texel.packed && (has_unequal || !scalar_of(texel.components[0].encoding, texel.components[0].bits))) {
    // Depth with stencil: no buffer of a script holds it, and no device of ours has it.
    if (texel.components.front().name != 'D') return std::nullopt;
  }
  texel.size = bits / 8;
  texel.format = rhi_format(texel);
  return texel;
}

std::optional<Texel> texel_of(const ValueType& type) {
  if (type.kind != ValueType::Kind::scalar && type.kind != ValueType::Kind::vector) return std::nullopt;
  const std::uint32_t bits = 8 * size_of(type.scalar);
  std::string name;
  for (std::uint32_t i = 0; i < type.rows; ++i) name += fmt::format("{}{}", "RGBA"[i], bits);
  return parse_texel(name + (is_floating(type.scalar) ? "_SFLOAT" : is_signed(type.scalar) ? "_SINT" : "_UINT"));
}

ValueType value_type_of(const Texel& texel) {
  if (!texel.packed && std::all_of(texel.components.begin(), texel.components.end(),
                                   [&](const Component& c) { return c.bits == texel.components.front().bits; }))
    if (const auto scalar = scalar_of(texel.components.front().encoding, texel.components.front().bits))
      return make_type(*scalar, static_cast<std::uint32_t>(texel.components.size()));
  return make_type(texel.size == 1   ? ScalarType::uint8
                   : texel.size == 2 ? ScalarType::uint16
                   : texel.size <= 4 ? ScalarType::uint32
                                     : ScalarType::uint64);
}

double value_of(const Component& component, std::span<const std::byte> texel) {
  // No component crosses the end of the eight bytes: those that do not begin at a byte are packed into four.
  std::uint64_t bits = 0;
  const std::span<const std::byte> rest = texel.subspan(component.offset / 8);
  std::memcpy(&bits, rest.data(), std::min(rest.size(), sizeof(bits)));
  bits >>= component.offset % 8;
  if (component.bits < 64) bits &= (std::uint64_t{1} << component.bits) - 1;
  const std::uint32_t unused = 64 - component.bits;
  const double as_signed = static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
  const double largest = std::ldexp(1.0, static_cast<int>(component.bits)) - 1;
  switch (component.encoding) {
    case Encoding::unorm:
      return static_cast<double>(bits) / largest;
    case Encoding::snorm:
      return std::max(as_signed / ((largest - 1) / 2), -1.0);
    case Encoding::srgb:
      if (component.name == 'A') return static_cast<double>(bits) / largest;
      return srgb_decode(static_cast<float>(static_cast<double>(bits) / largest));
    case Encoding::uint:
    case Encoding::uscaled:
      return static_cast<double>(bits);
    case Encoding::sint:
    case Encoding::sscaled:
      return as_signed;
    case Encoding::sfloat:
    case Encoding::ufloat:
      if (component.bits == 64) return std::bit_cast<double>(bits);
      if (component.bits == 32) return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
      if (component.bits == 16) return from_half(static_cast<std::uint16_t>(bits));
      return small_float(bits, component.bits);
  }
  return 0;
}

}  // namespace tandem::program::amber
