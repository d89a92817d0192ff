#pragma once

#include <cstddef>
#include <cstdint>

#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/kernel/images.hpp"
#include "rhi_cpu/kernel/math.hpp"
#include "rhi_cpu/kernel/texels.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// What a sampler says, after Vulkan's chapter "Image Operations": which texels, of which levels, with which weights,
/// and how depths are compared.
namespace tandem::kernel {

/// The texel that coordinate `i` of a side of `size` texels means; -1 for the border.
inline int wrapped(int i, int size, AddressMode mode) {
  const auto modulo = [](int n, int by) { return n % by < 0 ? n % by + by : n % by; };
  switch (mode) {
    case AddressMode::repeat:
      return modulo(i, size);
    case AddressMode::mirrored_repeat: {
      const int n = modulo(i, 2 * size);
      return n < size ? n : 2 * size - 1 - n;
    }
    case AddressMode::clamp_to_edge:
      return kernel::clamp(i, 0, size - 1);
    case AddressMode::clamp_to_border:
      return i < 0 || i >= size ? -1 : i;
    case AddressMode::mirror_clamp_to_edge:
      return kernel::min(i < 0 ? -(1 + i) : i, size - 1);
  }
  return -1;
}

/// Two neighbours along one side.
struct Neighbours {
  int low, high;
  float weight;  ///< of the higher one
};

/// Of u, in texels: what a linear filter takes, before wrapping.
inline Neighbours neighbours_of(float u) {
  const float from = u - 0.5f;
  const float whole = kernel::floor(from);
  const int low = float_to_signed<int>(whole);
  return {low, low + 1, from - whole};
}

/// The colour of the border, as a texel of the image: components that its format lacks are 0, alpha 1.
template <typename C>
inline glm::vec<4, C> border_texel(const Image& image, const Sampler& sampler) {
  const C colour = sampler.border >= BorderColor::float_opaque_white ? C(1) : C(0);
  const C alpha = sampler.border >= BorderColor::float_opaque_black ? C(1) : C(0);
  glm::vec<4, C> texel(colour, colour, colour, alpha);
  for (int i = texel_layouts[image.format].components; i < 4; ++i) texel[i] = i == 3 ? C(1) : C(0);
  return texel;
}

/// Whether a depth passes, as 0 or 1.
inline float compare_depth(CompareOp op, float reference, float depth) {
  switch (op) {
    case CompareOp::never:
      return 0.0f;
    case CompareOp::less:
      return reference < depth ? 1.0f : 0.0f;
    case CompareOp::equal:
      return reference == depth ? 1.0f : 0.0f;
    case CompareOp::less_or_equal:
      return reference <= depth ? 1.0f : 0.0f;
    case CompareOp::greater:
      return reference > depth ? 1.0f : 0.0f;
    case CompareOp::not_equal:
      return reference != depth ? 1.0f : 0.0f;
    case CompareOp::greater_or_equal:
      return reference >= depth ? 1.0f : 0.0f;
    case CompareOp::always:
      return 1.0f;
  }
  return 0.0f;
}

/// Which filter, and which levels: `level`, and where `weight` is not 0 the next one with that weight.
struct Levels {
  Filter filter;
  std::uint32_t level;
  float weight;
};

/// "Scale Factor, Level-of-Detail and Image Level Selection".
/// @param detail before the sampler's bias and limits
/// @param least the shader's own limit
inline Levels levels_of(const Image& image, const Sampler& sampler, float detail, float least) {
  const float limited = kernel::clamp(detail + sampler.lod_bias, kernel::max(sampler.min_lod, least), sampler.max_lod);
  const Filter filter = limited <= 0.0f ? sampler.magnification : sampler.minification;
  const float last = static_cast<float>(image.level_count - 1);
  const float at = kernel::clamp(limited, 0.0f, last);
  if (sampler.mipmap == Filter::nearest)
    return {filter, static_cast<std::uint32_t>(kernel::max(kernel::ceil(at + 0.5f) - 1.0f, 0.0f)), 0.0f};
  const float whole = kernel::floor(at);
  return {filter, static_cast<std::uint32_t>(whole), at - whole};
}

/// One level of an image of any format.
template <typename C>
struct Level {
  Level(const Image& image, std::uint32_t level)
      : texels(image.texels + image.level_offsets[level]),
        size(level_size(&image, level)),
        bytes(texel_layouts[image.format].bytes),
        decode(decoders<C>[image.format]) {}

  /// A texel inside.
  glm::vec<4, C> operator[](const ivec3& at) const {
    const auto x = static_cast<std::size_t>(at.x), y = static_cast<std::size_t>(at.y),
               z = static_cast<std::size_t>(at.z);
    return decode(texels + ((z * static_cast<std::size_t>(size.y) + y) * static_cast<std::size_t>(size.x) + x) * bytes);
  }

  const std::byte* texels;
  ivec3 size;
  std::uint32_t bytes;
  Decoder<C> decode;
};

}  // namespace tandem::kernel
