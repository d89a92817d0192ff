#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/kernel/memory.hpp"
#include "rhi_cpu/kernel/packing.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// Storage images. A texel outside of the image reads as zero and is not written. Conversions are those of Vulkan's
/// "Fixed-Point Data Conversions", rounded to the nearest; integers that do not fit keep their low bits.
namespace tandem::kernel {

/// rhi::TextureFormat, and what a shader says that names none.
enum class TexelFormat : std::uint32_t {
  r8_unorm,
  r8_snorm,
  r8_uint,
  r8_sint,
  rg8_unorm,
  rg8_snorm,
  rg8_uint,
  rg8_sint,
  rgba8_unorm,
  rgba8_snorm,
  rgba8_uint,
  rgba8_sint,
  r16_unorm,
  r16_snorm,
  r16_uint,
  r16_sint,
  r16_float,
  rg16_unorm,
  rg16_snorm,
  rg16_uint,
  rg16_sint,
  rg16_float,
  rgba16_unorm,
  rgba16_snorm,
  rgba16_uint,
  rgba16_sint,
  rgba16_float,
  r32_uint,
  r32_sint,
  r32_float,
  rg32_uint,
  rg32_sint,
  rg32_float,
  rgba32_uint,
  rgba32_sint,
  rgba32_float,
  r64_uint,
  r64_sint,
  rgb10a2_unorm,
  rgb10a2_uint,
  rg11b10_float,
  rgba8_srgb,
  bgra8_unorm,
  d16_unorm,
  d32_float,
  of_the_image  ///< Image::format decides, when the shader runs
};

/// Bytes of a texel of each TexelFormat.
inline constexpr std::uint8_t texel_sizes[] = {1, 1, 1, 1, 2, 2, 2, 2, 4, 4, 4,  4,  2,  2, 2, 2, 2, 4, 4, 4, 4, 4, 8,
                                               8, 8, 8, 8, 4, 4, 4, 8, 8, 8, 16, 16, 16, 8, 8, 4, 4, 4, 4, 4, 2, 4};

constexpr std::uint32_t bytes_of(TexelFormat format) { return texel_sizes[static_cast<std::uint32_t>(format)]; }

/// Components of type Stored, of which a texel has `count`, as the four of a value: (0, 0, 0, 1) where it has none.
template <typename C, typename Stored, int count>
inline glm::vec<4, C> load_components(const std::byte* texel) {
  glm::vec<4, C> value(C(0), C(0), C(0), C(1));
  for (int i = 0; i < count; ++i) value[i] = static_cast<C>(load<Stored>(texel + i * sizeof(Stored)));
  return value;
}

template <typename C, typename Stored, int count>
inline void store_components(std::byte* texel, const glm::vec<4, C>& value) {
  for (int i = 0; i < count; ++i) store(texel + i * sizeof(Stored), static_cast<Stored>(value[i]));
}

/// A texel as components of type C: float, or int or uint for a format of integers. Zero for a format of another kind.
template <typename C>
inline glm::vec<4, C> decode_texel(TexelFormat format, const std::byte* texel) {
  if constexpr (std::is_floating_point_v<C>) {
    switch (format) {
      case TexelFormat::rgba8_unorm:
        return unpack_unorm_4x8(load<std::uint32_t>(texel));
      case TexelFormat::rgba8_snorm:
        return unpack_snorm_4x8(load<std::uint32_t>(texel));
      case TexelFormat::rgba16_float: {
        const vec2 low = unpack_half_2x16(load<std::uint32_t>(texel));
        const vec2 high = unpack_half_2x16(load<std::uint32_t>(texel + 4));
        return vec4(low.x, low.y, high.x, high.y);
      }
      case TexelFormat::r32_float:
        return load_components<C, float, 1>(texel);
      case TexelFormat::rg32_float:
        return load_components<C, float, 2>(texel);
      case TexelFormat::rgba32_float:
        return load_components<C, float, 4>(texel);
      default:
        return vec4(0.0f);
    }
  } else {
    switch (format) {
      case TexelFormat::rgba8_uint:
        return load_components<C, std::uint8_t, 4>(texel);
      case TexelFormat::rgba8_sint:
        return load_components<C, std::int8_t, 4>(texel);
      case TexelFormat::rgba16_uint:
        return load_components<C, std::uint16_t, 4>(texel);
      case TexelFormat::rgba16_sint:
        return load_components<C, std::int16_t, 4>(texel);
      case TexelFormat::r32_uint:
      case TexelFormat::r32_sint:
        return load_components<C, std::uint32_t, 1>(texel);
      case TexelFormat::rg32_uint:
      case TexelFormat::rg32_sint:
        return load_components<C, std::uint32_t, 2>(texel);
      case TexelFormat::rgba32_uint:
      case TexelFormat::rgba32_sint:
        return load_components<C, std::uint32_t, 4>(texel);
      default:
        return glm::vec<4, C>(C(0));
    }
  }
}

/// The other way; does nothing for a format of another kind.
template <typename C>
inline void encode_texel(TexelFormat format, std::byte* texel, const glm::vec<4, C>& value) {
  if constexpr (std::is_floating_point_v<C>) {
    switch (format) {
      case TexelFormat::rgba8_unorm:
        return store(texel, pack_unorm_4x8(value));
      case TexelFormat::rgba8_snorm:
        return store(texel, pack_snorm_4x8(value));
      case TexelFormat::rgba16_float:
        store(texel, pack_half_2x16(vec2(value.x, value.y)));
        return store(texel + 4, pack_half_2x16(vec2(value.z, value.w)));
      case TexelFormat::r32_float:
        return store_components<C, float, 1>(texel, value);
      case TexelFormat::rg32_float:
        return store_components<C, float, 2>(texel, value);
      case TexelFormat::rgba32_float:
        return store_components<C, float, 4>(texel, value);
      default:
        return;
    }
  } else {
    switch (format) {
      case TexelFormat::rgba8_uint:
      case TexelFormat::rgba8_sint:
        return store_components<C, std::uint8_t, 4>(texel, value);
      case TexelFormat::rgba16_uint:
      case TexelFormat::rgba16_sint:
        return store_components<C, std::uint16_t, 4>(texel, value);
      case TexelFormat::r32_uint:
      case TexelFormat::r32_sint:
        return store_components<C, std::uint32_t, 1>(texel, value);
      case TexelFormat::rg32_uint:
      case TexelFormat::rg32_sint:
        return store_components<C, std::uint32_t, 2>(texel, value);
      case TexelFormat::rgba32_uint:
      case TexelFormat::rgba32_sint:
        return store_components<C, std::uint32_t, 4>(texel, value);
      default:
        return;
    }
  }
}

/// The texel at a coordinate of one to three integers (x, y, z or layer), null outside of the image.
template <typename Coordinate>
inline std::byte* texel_at(const Image* image, const Coordinate& coordinate, std::uint32_t bytes) {
  uvec3 at(0u);
  if constexpr (length_of<Coordinate> == 0)
    at.x = static_cast<std::uint32_t>(coordinate);
  else
    for (int i = 0; i < length_of<Coordinate>; ++i) at[i] = static_cast<std::uint32_t>(coordinate[i]);
  const auto& size = image->size;
  if (at.x >= size[0] || at.y >= size[1] || at.z >= size[2]) return nullptr;
  return image->texels + ((std::size_t{at.z} * size[1] + at.y) * size[0] + at.x) * bytes;
}

template <TexelFormat format>
inline TexelFormat format_of(const Image* image) {
  return format == TexelFormat::of_the_image ? static_cast<TexelFormat>(image->format) : format;
}

/// imageLoad of an image whose texels have components of type C.
template <typename C, TexelFormat format, typename Coordinate>
inline glm::vec<4, C> image_load(const Image* image, const Coordinate& coordinate) {
  const TexelFormat stored = format_of<format>(image);
  const std::byte* texel = texel_at(image, coordinate, bytes_of(stored));
  return texel == nullptr ? glm::vec<4, C>(C(0)) : decode_texel<C>(stored, texel);
}

/// imageStore.
template <typename C, TexelFormat format, typename Coordinate>
inline void image_store(const Image* image, const Coordinate& coordinate, const glm::vec<4, C>& value) {
  const TexelFormat stored = format_of<format>(image);
  std::byte* texel = texel_at(image, coordinate, bytes_of(stored));
  if (texel != nullptr) encode_texel<C>(stored, texel, value);
}

inline uvec3 image_size(const Image* image) { return uvec3(image->size[0], image->size[1], image->size[2]); }

/// Stands for the texels outside of an image during one atomic operation.
struct NoTexel {
  alignas(8) std::byte bytes[8] = {};
};

/// The memory of a texel of 32 bits, for an atomic operation.
template <typename Coordinate>
inline std::byte* texel_pointer(const Image* image, const Coordinate& coordinate, NoTexel&& outside) {
  std::byte* texel = texel_at(image, coordinate, 4);
  return texel != nullptr ? texel : outside.bytes;
}

}  // namespace tandem::kernel
