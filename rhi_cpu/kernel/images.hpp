#pragma once

#include <cstddef>
#include <cstdint>

#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/kernel/components.hpp"
#include "rhi_cpu/kernel/memory.hpp"
#include "rhi_cpu/kernel/texels.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// Storage images and storage texel buffers: level 0 of a kernel::Image. A texel outside of the image reads as
/// nothing_of() and is not written.
namespace tandem::kernel {

/// What is read outside of an image: zeros, as a texel of its format has them, so alpha is 1 where the format lacks it
/// (Vulkan's robustImageAccess2).
template <typename C>
inline glm::vec<4, C> nothing_of(std::uint32_t format) {
  return glm::vec<4, C>(C(0), C(0), C(0), texel_layouts[format].components < 4 ? C(1) : C(0));
}

/// What a shader declares an image as: rhi::TextureDimension. A texel buffer is d1.
enum class Shape : std::uint32_t { d1, d2, d3, cube, d1_array, d2_array, cube_array };

template <TexelFormat format>
inline std::uint32_t texel_bytes(const Image* image) {
  if constexpr (format == TexelFormat::of_the_image)
    return texel_layouts[image->format].bytes;
  else
    return layout_of(format).bytes;
}

/// The texel at a coordinate of one to three integers (x, y, z, or a layer behind the sides; of a cube the layer is the
/// face, and six times the number of the cube), null outside of the image.
template <typename Coordinate>
inline std::byte* texel_at(const Image* image, const Coordinate& coordinate, std::uint32_t bytes) {
  uvec3 at(0u);
  if constexpr (length_of<Coordinate> == 0)
    at.x = static_cast<std::uint32_t>(coordinate);
  else
    for (int i = 0; i < length_of<Coordinate>; ++i) at[i] = static_cast<std::uint32_t>(coordinate[i]);
  const auto& size = image->size;
  if (at.x >= size[0] || at.y >= size[1] || at.z >= size[2]) return nullptr;
  return image->texels + image->level_offsets[0] + ((std::size_t{at.z} * size[1] + at.y) * size[0] + at.x) * bytes;
}

/// imageLoad of an image whose texels have components of type C.
template <typename C, TexelFormat format, typename Coordinate>
inline glm::vec<4, C> image_load(const Image* image, const Coordinate& coordinate) {
  const std::byte* texel = texel_at(image, coordinate, texel_bytes<format>(image));
  if (texel == nullptr)
    return nothing_of<C>(format == TexelFormat::of_the_image ? image->format : static_cast<std::uint32_t>(format));
  if constexpr (format == TexelFormat::of_the_image)
    return decoders<C>[image->format](texel);
  else
    return decode<C, format>(texel);
}

/// imageStore.
template <typename C, TexelFormat format, typename Coordinate>
inline void image_store(const Image* image, const Coordinate& coordinate, const glm::vec<4, C>& value) {
  std::byte* texel = texel_at(image, coordinate, texel_bytes<format>(image));
  if (texel == nullptr) return;
  if constexpr (format == TexelFormat::of_the_image)
    encoders<C>[image->format](texel, value);
  else
    encode<C, format>(texel, value);
}

/// Sides and layers of a level; 0 for a level that the image does not have.
inline uvec3 level_size(const Image* image, std::uint32_t level) {
  if (level >= image->level_count) return uvec3(0u);
  uvec3 size(image->size[0], image->size[1], image->size[2]);
  for (int i = 0; i < static_cast<int>(image->sides); ++i) size[i] = kernel::max(size[i] >> level, 1u);
  return size;
}

/// imageSize and textureSize: the same, where an array of cubes has cubes.
template <Shape shape>
inline uvec3 image_size(const Image* image, std::uint32_t level = 0) {
  uvec3 size = level_size(image, level);
  if constexpr (shape == Shape::cube_array) size.z /= 6u;
  return size;
}

/// Stands for the texels outside of an image during one atomic operation.
struct NoTexel {
  alignas(8) std::byte bytes[8] = {};
};

/// The memory of a texel of `bytes` bytes, 4 or 8, for an atomic operation.
template <typename Coordinate>
inline std::byte* texel_pointer(const Image* image, const Coordinate& coordinate, std::uint32_t bytes,
                                NoTexel&& outside) {
  std::byte* texel = texel_at(image, coordinate, bytes);
  return texel != nullptr ? texel : outside.bytes;
}

}  // namespace tandem::kernel
