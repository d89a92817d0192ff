#include "program/data/texels.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "program/data/scalar.hpp"

namespace tandem::program {
namespace {

using rhi::ComponentKind;
using rhi::TextureFormat;

ScalarType scalar_of(std::uint32_t size, ComponentKind kind) {
  const bool is_float = kind == ComponentKind::floating || (kind == ComponentKind::depth && size == 4);
  const bool has_sign = kind == ComponentKind::sint || kind == ComponentKind::snorm;
  switch (size) {
    case 1:
      return has_sign ? ScalarType::int8 : ScalarType::uint8;
    case 2:
      return is_float ? ScalarType::float16 : has_sign ? ScalarType::int16 : ScalarType::uint16;
    case 4:
      return is_float ? ScalarType::float32 : has_sign ? ScalarType::int32 : ScalarType::uint32;
    default:
      return has_sign ? ScalarType::int64 : ScalarType::uint64;
  }
}

ScalarType component_of(TextureFormat format) {
  const rhi::TextureFormatInfo& info = rhi::info_of(format);
  return has_plain_components(format) ? scalar_of(info.size / info.components, info.kind) : ScalarType::uint32;
}

ValueType level_type(const rhi::TextureDesc& desc, std::uint32_t level) {
  const std::array<std::uint32_t, 3> size = rhi::level_size(desc, level);
  ValueType type = make_array(texel_type(desc.format), size[0]);
  if (rhi::side_count(desc.dimension) > 1) type = make_array(std::move(type), size[1]);
  if (size[2] > 1) type = make_array(std::move(type), size[2]);
  return type;
}

/// The largest stored number of a normalised format, which means 1; 0 for other formats.
double scale_of(TextureFormat format) {
  const int bits = static_cast<int>(8 * size_of(component_of(format)));
  switch (rhi::info_of(format).kind) {
    case ComponentKind::unorm:
      return std::ldexp(1.0, bits) - 1;
    case ComponentKind::snorm:
      return std::ldexp(1.0, bits - 1) - 1;
    case ComponentKind::depth:
      return bits == 16 ? 65535.0 : 0.0;
    default:
      return 0.0;
  }
}

/// Where a component of RGBA lies in a texel.
std::uint32_t position_of(TextureFormat format, std::uint32_t component) {
  return format == TextureFormat::bgra8_unorm && component != 3 ? 2 - component : component;
}

}  // namespace

bool has_plain_components(TextureFormat format) {
  return format != TextureFormat::rgb10a2_unorm && format != TextureFormat::rgb10a2_uint &&
         format != TextureFormat::rg11b10_float;
}

ValueType texel_type(TextureFormat format) {
  return make_type(component_of(format), has_plain_components(format) ? rhi::info_of(format).components : 1);
}

ValueType texture_type(const rhi::TextureDesc& desc) {
  if (desc.level_count == 1) return level_type(desc, 0);
  ValueType type{.kind = ValueType::Kind::structure};
  for (std::uint32_t level = 0; level < desc.level_count; ++level)
    type.members.push_back({.name = fmt::format("level{}", level),
                            .offset = rhi::level_offset(desc, level),
                            .type = level_type(desc, level)});
  type.size = type.members.back().offset + type.members.back().type.size;
  return type;
}

std::vector<std::byte> texels_of(TextureFormat format, std::span<const float> rgba) {
  const rhi::TextureFormatInfo& info = rhi::info_of(format);
  const ScalarType scalar = component_of(format);
  const double scale = scale_of(format);
  std::vector<std::byte> bytes(rgba.size() / 4 * info.size);
  for (std::size_t texel = 0; texel < rgba.size() / 4; ++texel)
    for (std::uint32_t i = 0; i < info.components; ++i) {
      const Place place{.offset = texel * info.size + position_of(format, i) * size_of(scalar), .scalar = scalar};
      const double least = info.kind == ComponentKind::snorm ? -1.0 : 0.0;
      const auto number = static_cast<double>(rgba[4 * texel + i]);
      const double stored = scale == 0.0         ? number
                            : std::isnan(number) ? 0.0
                                                 : std::nearbyint(std::clamp(number, least, 1.0) * scale);
      set_bits(bytes, place, bits_of_number(scalar, stored));
    }
  return bytes;
}

std::vector<float> rgba_of(TextureFormat format, std::span<const std::byte> texels) {
  const rhi::TextureFormatInfo& info = rhi::info_of(format);
  const ScalarType scalar = component_of(format);
  const double scale = scale_of(format);
  std::vector<float> rgba(texels.size() / info.size * 4, 0.0f);
  for (std::size_t texel = 0; texel < rgba.size() / 4; ++texel) {
    rgba[4 * texel + 3] = 1.0f;
    for (std::uint32_t i = 0; i < info.components; ++i) {
      const Place place{.offset = texel * info.size + position_of(format, i) * size_of(scalar), .scalar = scalar};
      const double number = number_of(scalar, bits_at(texels, place));
      rgba[4 * texel + i] = static_cast<float>(scale == 0.0 ? number : std::max(number / scale, -1.0));
    }
  }
  return rgba;
}

}  // namespace tandem::program
