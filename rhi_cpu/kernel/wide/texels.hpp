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

// Two or four words of each of 8 lanes are one number in memory. In registers, lanes lie side by side; a half of one
// has words of lanes 0 to 3, or 4 to 7.

typedef std::uint32_t FourWords __attribute__((vector_size(16)));
typedef std::uint32_t EightWords __attribute__((vector_size(32)));

/// Four times four words become columns of what they were rows of, in each half.
inline void transpose(EightWords (&rows)[4]) {
  const auto [a, b, c, d] = rows;
  const EightWords ab = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
  const EightWords cd = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
  const EightWords ab_end = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
  const EightWords cd_end = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
  rows[0] = __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13);
  rows[1] = __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15);
  rows[2] = __builtin_shufflevector(ab_end, cd_end, 0, 1, 8, 9, 4, 5, 12, 13);
  rows[3] = __builtin_shufflevector(ab_end, cd_end, 2, 3, 10, 11, 6, 7, 14, 15);
}

template <std::size_t bytes>
inline void load_transposed(const std::byte* data, const Words& offsets, StoredTexels<bytes>& texels) {
  const auto both = [](FourWords low, FourWords high) {
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
  };
  const auto set = [&](int word, EightWords lanes) { std::memcpy(&texels.words[word].of_lane, &lanes, sizeof(lanes)); };
  if constexpr (bytes == 8) {
    typedef std::uint64_t Pair __attribute__((vector_size(16)));
    const auto two = [&](int lane) {
      return reinterpret_cast<FourWords>(
          Pair{load<std::uint64_t>(data + offsets[lane]), load<std::uint64_t>(data + offsets[lane + 1])});
    };
    const EightWords a = both(two(0), two(4)), b = both(two(2), two(6));
    set(0, __builtin_shufflevector(a, b, 0, 2, 8, 10, 4, 6, 12, 14));
    set(1, __builtin_shufflevector(a, b, 1, 3, 9, 11, 5, 7, 13, 15));
  } else {
    static_assert(bytes == 16);
    EightWords rows[4];
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i)
      rows[i] = both(load<FourWords>(data + offsets[i]), load<FourWords>(data + offsets[i + 4]));
    transpose(rows);
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) set(i, rows[i]);
  }
}

/// store(lane, texel) of each lane.
template <std::size_t bytes, typename Store>
inline void store_transposed(const StoredTexels<bytes>& texels, const Store& store) {
  EightWords rows[4] = {};
  for (std::size_t i = 0; i < texels.word_count; ++i) std::memcpy(&rows[i], &texels.words[i].of_lane, sizeof(rows[i]));
  transpose(rows);
#pragma GCC unroll 8
  for (int i = 0; i < 8; ++i) {
    std::uint32_t words[4];
    const EightWords& row = rows[i % 4];
    const FourWords half =
        i < 4 ? __builtin_shufflevector(row, row, 0, 1, 2, 3) : __builtin_shufflevector(row, row, 4, 5, 6, 7);
    std::memcpy(words, &half, sizeof(words));
    store(i, words);
  }
}

/// The number of 32 bits at byte offsets from `data`.
inline Words words_at(const std::byte* data, const Words& offsets) {
  Words words;
#pragma GCC unroll 32
  for (int i = 0; i < lane_count; ++i) words.set(i, load<std::uint32_t>(data + offsets[i]));
  return words;
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
    if constexpr (bytes > 4 && lane_count == 8)
      load_transposed(data, offsets, texels);
    else
      for (std::size_t k = 0; k < texels.word_count; ++k) texels.words[k] = words_at(data + 4 * k, offsets);
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
  if constexpr (bytes > 4 && lane_count == 8) {
    const std::uint32_t bits = bits_of(mask);
    store_transposed(texels, [&](int lane, const std::uint32_t* texel) {
      if ((bits >> lane & 1u) != 0) std::memcpy(data + offsets[lane], texel, bytes);
    });
    return;
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
/// compares all of them.
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

/// Bits of a component, and where in a texel it begins.
template <TexelFormat format>
inline constexpr int component_bits = 8 * layout_of(format).bytes / layout_of(format).components;
template <TexelFormat format>
constexpr int first_bit(int component) {
  return component_bits<format> * stored_index(format, component);
}

/// One component as kernel::decode gives it, of the word that has it.
template <typename C, TexelFormat format>
inline Lanes<C> decoded_word(const Words& word, int component) {
  constexpr Coding coding = layout_of(format).coding;
  constexpr int bits = component_bits<format>;
  Words code = word;
  if constexpr (bits < 32) code = Words((code.of_lane >> (first_bit<format>(component) % 32)) & ((1u << bits) - 1u));
  if constexpr (std::is_integral_v<C>) {
    if constexpr (coding == Coding::sint)
      code = Words(reinterpret_cast<Words::Register>(reinterpret_cast<Ints::Register>(code.of_lane << (32 - bits)) >>
                                                     (32 - bits)));
    return kernel::bit_cast<Lanes<C>>(code);
  } else if constexpr (coding == Coding::srgb) {
    if (component == 3) return unorm_of<bits>(code);
    return each([](std::uint32_t c) { return srgb_to_linear[c]; }, code);
  } else if constexpr (coding == Coding::unorm || coding == Coding::bgra_unorm) {
    return unorm_of<bits>(code);
  } else if constexpr (bits == 16) {
    return floats_of(Lanes<std::uint16_t>(code));
  } else {
    return kernel::bit_cast<Floats>(code);
  }
}

/// What a component is that the format lacks.
template <typename C>
inline Lanes<C> missing_component(int component) {
  return Lanes<C>(component == 3 ? C(1) : C(0));
}

template <typename C, TexelFormat format, std::size_t bytes>
inline Lanes<C> decoded_component(const StoredTexels<bytes>& texels, int component) {
  if (component >= layout_of(format).components) return missing_component<C>(component);
  return decoded_word<C, format>(texels.words[first_bit<format>(component) / 32], component);
}
template <typename C, TexelFormat format, std::size_t bytes>
inline glm::vec<4, Lanes<C>> decoded(const StoredTexels<bytes>& texels) {
  return {decoded_component<C, format>(texels, 0), decoded_component<C, format>(texels, 1),
          decoded_component<C, format>(texels, 2), decoded_component<C, format>(texels, 3)};
}

/// The codes of a component as kernel::encode makes them.
template <typename C, TexelFormat format>
inline Words encoded_component(const Lanes<C>& value, int component) {
  constexpr TexelLayout layout = layout_of(format);
  constexpr int bits = component_bits<format>;
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
  StoredTexels<layout.bytes> texels;
  for (Words& word : texels.words) word = Words(0u);
#pragma GCC unroll 4
  for (int i = 0; i < layout.components; ++i) {
    const int first = first_bit<format>(i);
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

  /// @param level one that the image has, of `sides`
  TexelLevel(const Image& image, std::uint32_t level, const uvec3& sides, std::uint32_t texel_bytes)
      : texels(image.texels + image.level_offsets[level]),
        size(sides),
        format(image.format),
        bytes(texel_bytes),
        is_small((std::size_t{size.x} * size.y * size.z * bytes) >> 32 == 0) {}
  TexelLevel(const Image& image, std::uint32_t level, const uvec3& sides)
      : TexelLevel(image, level, sides, texel_layouts[image.format].bytes) {}

  /// The byte offset of the texel at (x, row), where rows are counted through all layers.
  Words offsets(const Words& x, const Words& row, std::uint32_t texel_bytes) const {
    return (row * Words(size.x) + x) * Words(texel_bytes);
  }
  std::byte* texel(std::uint32_t x, std::uint32_t row) const {
    return texels + (std::size_t{row} * size.x + x) * bytes;
  }
};

}  // namespace tandem::kernel
