#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "rhi_cpu/kernel/images.hpp"
#include "rhi_cpu/kernel/texels.hpp"
#include "rhi_cpu/kernel/wide/functions.hpp"
#include "rhi_cpu/kernel/wide/half_conversion.hpp"
#include "rhi_cpu/kernel/wide/lanes.hpp"

/// Texels of all lanes at once, with the bits that kernel/texels.hpp gives each lane.
namespace tandem::kernel {

using Floats = Lanes<float>;
using Ints = Lanes<std::int32_t>;
using Words = Lanes<std::uint32_t>;

/// The texels of all lanes as they are stored, the first 32 bits first.
template <std::size_t bytes>
struct StoredTexels {
  static constexpr std::size_t word_count = (bytes + 3) / 4;
  Words words[word_count];
};

/// 0, 1, 2... times `step`.
inline Words row_of_words(std::uint32_t step) {
  Words row;
  for (int i = 0; i < lane_count; ++i) row.set(i, static_cast<std::uint32_t>(i) * step);
  return row;
}

inline bool are_neighbours(const Words& offsets, std::uint32_t distance) {
  return bits_of(offsets == Words(offsets[0]) + row_of_words(distance)) == all_bits;
}

/// The texels at byte offsets from `data`.
template <std::size_t bytes>
inline StoredTexels<bytes> stored_texels(const std::byte* data, const Words& offsets) {
  StoredTexels<bytes> texels;
  if constexpr (bytes < 4) {
    using Code = typename IntegerOf<bytes, false>::type;
#pragma GCC unroll 32
    for (int i = 0; i < lane_count; ++i) texels.words[0].set(i, load<Code>(data + offsets[i]));
  } else {
    if constexpr (bytes == 4) {
      if (are_neighbours(offsets, bytes)) {
        std::memcpy(&texels.words[0].of_lane, data + offsets[0], sizeof(texels.words[0].of_lane));
        return texels;
      }
    }
    for (std::size_t k = 0; k < texels.word_count; ++k)
#pragma GCC unroll 32
      for (int i = 0; i < lane_count; ++i) texels.words[k].set(i, load<std::uint32_t>(data + 4 * k + offsets[i]));
  }
  return texels;
}

/// Stores the texels of the lanes in `mask`, in their order.
template <std::size_t bytes>
inline void store_texels(Mask mask, std::byte* data, const Words& offsets, const StoredTexels<bytes>& texels) {
  if constexpr (bytes == 4) {
    if (bits_of(mask) == all_bits && are_neighbours(offsets, bytes)) {
      std::memcpy(data + offsets[0], &texels.words[0].of_lane, sizeof(texels.words[0].of_lane));
      return;
    }
  }
  for (int i = 0; i < lane_count; ++i) {
    if (!mask[i]) continue;
    for (std::size_t k = 0; k < texels.word_count; ++k) {
      const std::uint32_t word = texels.words[k][i];
      std::memcpy(data + offsets[i] + 4 * k, &word, bytes < 4 ? bytes : 4);
    }
  }
}

/// What code / (2^bits - 1) rounds to, for a code of 8 or 16 bits: with c = code / 2^bits, c + c / (2^bits - 1). A test
/// compares all codes.
template <int bits>
inline Floats unorm_of(const Words& codes) {
  constexpr float step = 1.0f / static_cast<float>(1u << bits), rest = step / unorm_scale(bits);
  const Floats code = Floats(Ints(codes));
  return code * step + code * rest;
}

/// float_to_unorm of every lane, for scales below 2^23.
inline Words unorm_codes(const Floats& values, float scale) {
  const Floats limited = kernel::clamp(values, Floats(0.0f), Floats(1.0f));
  constexpr float whole_from = all_whole_from<float>;
  // The sum's last bits are the rounded number.
  return kernel::bit_cast<Words>(limited * scale + whole_from) - Words(std::bit_cast<std::uint32_t>(whole_from));
}

/// Whether decoded_component knows the format: its components lie one after the other, with no more than 32 bits each.
constexpr bool has_lanes(TexelFormat format) {
  const TexelLayout layout = layout_of(format);
  if (layout.coding == Coding::srgb || layout.coding == Coding::bgra_unorm) return true;
  return layout.coding <= Coding::floating && layout.coding != Coding::snorm && layout.bytes / layout.components <= 4;
}

/// Where a component is among those that are stored.
constexpr int stored_index(TexelFormat format, int component) {
  return layout_of(format).coding == Coding::bgra_unorm && component < 3 ? 2 - component : component;
}

/// One component as kernel::decode gives it.
template <typename C, TexelFormat format, std::size_t bytes>
inline Lanes<C> decoded_component(const StoredTexels<bytes>& texels, int component) {
  constexpr TexelLayout layout = layout_of(format);
  constexpr int bits = 8 * layout.bytes / layout.components;
  if (component >= layout.components) return Lanes<C>(component == 3 ? C(1) : C(0));
  const int first = bits * stored_index(format, component);
  Words code = texels.words[first / 32];
  if constexpr (bits < 32) code = Words((code.of_lane >> (first % 32)) & ((1u << bits) - 1u));
  if constexpr (std::is_integral_v<C>) {
    if constexpr (layout.coding == Coding::sint)
      code = Words(reinterpret_cast<Words::Register>(reinterpret_cast<Ints::Register>(code.of_lane << (32 - bits)) >>
                                                     (32 - bits)));
    return kernel::bit_cast<Lanes<C>>(code);
  } else if constexpr (layout.coding == Coding::srgb) {
    if (component == 3) return unorm_of<bits>(code);
    return each([](std::uint32_t c) { return srgb_to_linear[c]; }, code);
  } else if constexpr (layout.coding == Coding::unorm || layout.coding == Coding::bgra_unorm) {
    return unorm_of<bits>(code);
  } else if constexpr (bits == 16) {
    return floats_of(Lanes<std::uint16_t>(code));
  } else {
    return kernel::bit_cast<Floats>(code);
  }
}

/// The codes of a component as kernel::encode makes them.
template <typename C, TexelFormat format>
inline Words encoded_component(const Lanes<C>& value, int component) {
  constexpr TexelLayout layout = layout_of(format);
  constexpr int bits = 8 * layout.bytes / layout.components;
  constexpr std::uint32_t all = bits == 32 ? ~0u : (1u << (bits % 32)) - 1u;
  if constexpr (std::is_integral_v<C>) {
    return kernel::bit_cast<Words>(value) & Words(all);
  } else if constexpr (layout.coding == Coding::srgb) {
    if (component == 3) return unorm_codes(value, unorm_scale(bits));
    return unorm_codes(each([](float x) { return linear_to_srgb(x); }, value), unorm_scale(bits));
  } else if constexpr (layout.coding == Coding::unorm || layout.coding == Coding::bgra_unorm) {
    return unorm_codes(value, unorm_scale(bits));
  } else if constexpr (bits == 16) {
    return Words(halves_of(value));
  } else {
    return kernel::bit_cast<Words>(value);
  }
}

template <typename C, TexelFormat format>
inline auto encoded(const glm::vec<4, Lanes<C>>& value) {
  constexpr TexelLayout layout = layout_of(format);
  constexpr int bits = 8 * layout.bytes / layout.components;
  StoredTexels<layout.bytes> texels;
  for (Words& word : texels.words) word = Words(0u);
  for (int i = 0; i < layout.components; ++i) {
    const int first = bits * stored_index(format, i);
    texels.words[first / 32] |= Words(encoded_component<C, format>(value[i], i).of_lane << (first % 32));
  }
  return texels;
}

/// A level of an image.
struct TexelLevel {
  std::byte* texels;
  uvec3 size;
  std::uint32_t format;
  std::uint32_t bytes;  ///< of a texel
  bool is_small;        ///< byte offsets have 32 bits

  TexelLevel(const Image& image, std::uint32_t level, const uvec3& sides)
      : texels(image.texels + image.level_offsets[level]),
        size(sides),
        format(image.format),
        bytes(texel_layouts[image.format].bytes),
        is_small((std::size_t{size.x} * size.y * size.z * bytes) >> 32 == 0) {}
  /// @param level one that the image has
  TexelLevel(const Image& image, std::uint32_t level) : TexelLevel(image, level, level_size(&image, level)) {}

  /// The byte offset of the texel at (x, row), where rows are counted through all layers.
  Words offsets(const Words& x, const Words& row, std::uint32_t texel_bytes) const {
    return (row * Words(size.x) + x) * Words(texel_bytes);
  }
  std::byte* texel(std::uint32_t x, std::uint32_t row) const {
    return texels + (std::size_t{row} * size.x + x) * bytes;
  }
};

/// Calls with_format.operator()<format>() for a format that is common and has lanes; @return false for others.
template <typename C, typename Function>
inline bool of_common_format(std::uint32_t format, const Function& with_format) {
#define TANDEM_FORMAT(name)                               \
  case TexelFormat::name:                                 \
    with_format.template operator()<TexelFormat::name>(); \
    return true;
  if constexpr (std::is_same_v<C, float>) {
    switch (static_cast<TexelFormat>(format)) {
      TANDEM_FORMAT(r8_unorm)
      TANDEM_FORMAT(rg8_unorm)
      TANDEM_FORMAT(rgba8_unorm)
      TANDEM_FORMAT(rgba8_srgb)
      TANDEM_FORMAT(bgra8_unorm)
      TANDEM_FORMAT(rgba16_unorm)
      TANDEM_FORMAT(r16_float)
      TANDEM_FORMAT(rg16_float)
      TANDEM_FORMAT(rgba16_float)
      TANDEM_FORMAT(r32_float)
      TANDEM_FORMAT(d32_float)
      TANDEM_FORMAT(rg32_float)
      TANDEM_FORMAT(rgba32_float)
      default:
        return false;
    }
  } else if constexpr (std::is_same_v<C, std::uint32_t>) {
    switch (static_cast<TexelFormat>(format)) {
      TANDEM_FORMAT(r8_uint)
      TANDEM_FORMAT(rgba8_uint)
      TANDEM_FORMAT(r16_uint)
      TANDEM_FORMAT(r32_uint)
      TANDEM_FORMAT(rg32_uint)
      TANDEM_FORMAT(rgba32_uint)
      default:
        return false;
    }
  } else {
    switch (static_cast<TexelFormat>(format)) {
      TANDEM_FORMAT(r32_sint)
      TANDEM_FORMAT(rg32_sint)
      TANDEM_FORMAT(rgba32_sint)
      default:
        return false;
    }
  }
#undef TANDEM_FORMAT
}

/// The texels at (x, row) inside of a level whose format is known when the shader runs.
template <typename C>
[[gnu::noinline]] inline glm::vec<4, Lanes<C>> texels_at(const TexelLevel& level, Words x, Words row) {
  glm::vec<4, Lanes<C>> value;
  const bool is_done = level.is_small && of_common_format<C>(level.format, [&]<TexelFormat format>() {
                         const auto texels = stored_texels<layout_of(format).bytes>(
                             level.texels, level.offsets(x, row, layout_of(format).bytes));
                         for (int i = 0; i < 4; ++i) value[i] = decoded_component<C, format>(texels, i);
                       });
  if (!is_done)
    for (int i = 0; i < lane_count; ++i)
      kernel::set_lane(value, i, decoders<C>[level.format](level.texel(x[i], row[i])));
  return value;
}

/// One component of them.
template <typename C>
[[gnu::noinline]] inline Lanes<C> components_at(const TexelLevel& level, Words x, Words row, int component) {
  Lanes<C> value;
  const bool is_done = level.is_small && of_common_format<C>(level.format, [&]<TexelFormat format>() {
                         const auto texels = stored_texels<layout_of(format).bytes>(
                             level.texels, level.offsets(x, row, layout_of(format).bytes));
                         value = decoded_component<C, format>(texels, component);
                       });
  if (!is_done)
    for (int i = 0; i < lane_count; ++i)
      value.set(i, decoders<C>[level.format](level.texel(x[i], row[i]))[component]);
  return value;
}

}  // namespace tandem::kernel
