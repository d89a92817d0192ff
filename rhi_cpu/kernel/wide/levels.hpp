#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "rhi_cpu/kernel/wide/texels.hpp"

/// Texels that lanes read of one level of an image whose format is known when the shader runs. What is long is no part
/// of the kernel's own code.
namespace tandem::kernel {

#define TANDEM_FORMAT(name)                               \
  case TexelFormat::name:                                 \
    with_format.template operator()<TexelFormat::name>(); \
    return true;

/// Calls with_format.operator()<format>() for one of the few formats that are worth long code of their own. @return
/// false for others
template <typename Function>
inline bool of_frequent_format(std::uint32_t format, const Function& with_format) {
  switch (static_cast<TexelFormat>(format)) {
    TANDEM_FORMAT(r8_unorm)
    TANDEM_FORMAT(rgba8_unorm)
    TANDEM_FORMAT(rgba8_srgb)
    TANDEM_FORMAT(rgba16_float)
    TANDEM_FORMAT(r32_float)
    TANDEM_FORMAT(rgba32_float)
    default:
      return false;
  }
}

/// The same for all formats that are read and written at once, in components of type C; others are from lane to lane.
template <typename C, typename Function>
inline bool of_common_format(std::uint32_t format, const Function& with_format) {
  if constexpr (std::is_same_v<C, float>) {
    switch (static_cast<TexelFormat>(format)) {
      TANDEM_FORMAT(rg8_unorm)
      TANDEM_FORMAT(bgra8_unorm)
      TANDEM_FORMAT(r16_float)
      TANDEM_FORMAT(rg16_float)
      TANDEM_FORMAT(rg32_float)
      TANDEM_FORMAT(d32_float)
      default:
        return of_frequent_format(format, with_format);
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
}
#undef TANDEM_FORMAT

/// The texels at (x, row), in a level.
template <typename C>
[[gnu::noinline]] inline glm::vec<4, Lanes<C>> texels_at(const TexelLevel& level, Words x, Words row) {
  glm::vec<4, Lanes<C>> value;
  const bool is_done = level.is_small && of_common_format<C>(level.format, [&]<TexelFormat format>() {
                         constexpr std::uint32_t bytes = layout_of(format).bytes;
                         value = decoded<C, format>(stored_texels<bytes>(level.texels, level.offsets(x, row, bytes)));
                       });
  if (!is_done)
    for (int i = 0; i < lane_count; ++i)
      kernel::set_lane(value, i, decoders<C>[level.format](level.texel(x[i], row[i])));
  return value;
}

/// Four texels of each lane: those at two columns of two rows.
struct SquareOfLanes {
  Words columns[2];
  Words rows[2];
};

/// The offsets of texels (0, 0), (1, 0), (0, 1) and (1, 1) of a square.
template <std::uint32_t bytes>
struct SquareOffsets {
  Words offsets[4];

  SquareOffsets(const TexelLevel& level, const SquareOfLanes& square) {
    const Words rows[2] = {square.rows[0] * Words(level.size.x), square.rows[1] * Words(level.size.x)};
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) offsets[i] = (rows[i / 2] + square.columns[i % 2]) * Words(bytes);
  }
};

/// One component of the texels of a square in a level, in the order of a gather: (0, 1), (1, 1), (1, 0), (0, 0).
template <typename C>
[[gnu::noinline]] inline glm::vec<4, Lanes<C>> components_of_square(const TexelLevel& level,
                                                                    const SquareOfLanes& square, int component) {
  constexpr int order[] = {2, 3, 1, 0};
  glm::vec<4, Lanes<C>> values;
  const bool is_done =
      level.is_small && of_common_format<C>(level.format, [&]<TexelFormat format>() {
        constexpr std::uint32_t bytes = layout_of(format).bytes;
        if (component >= layout_of(format).components) {
          values = glm::vec<4, Lanes<C>>(missing_component<C>(component));
          return;
        }
        const SquareOffsets<bytes> at(level, square);
#pragma GCC unroll 4
        for (int i = 0; i < 4; ++i) {
          if constexpr (bytes <= 4)
            values[i] =
                decoded_component<C, format>(stored_texels<bytes>(level.texels, at.offsets[order[i]]), component);
          else
            values[i] = decoded_word<C, format>(
                words_at(level.texels + first_bit<format>(component) / 32 * 4, at.offsets[order[i]]), component);
        }
      });
  if (!is_done)
    for (int i = 0; i < 4; ++i)
      values[i] = texels_at<C>(level, square.columns[order[i] % 2], square.rows[order[i] / 2])[component];
  return values;
}

/// The linear filter over a square in a level: along columns, then between rows, as blended() does it.
[[gnu::noinline]] inline glm::vec<4, Floats> blended_square(const TexelLevel& level, const SquareOfLanes& square,
                                                            Floats between_columns, Floats between_rows) {
  glm::vec<4, Floats> value;
  const auto blend = [&](const Floats& a, const Floats& b, const Floats& c, const Floats& d) {
    const Floats low = a + (b - a) * between_columns, high = c + (d - c) * between_columns;
    return low + (high - low) * between_rows;
  };
  const bool is_done =
      level.is_small && of_frequent_format(level.format, [&]<TexelFormat format>() {
        constexpr std::uint32_t bytes = layout_of(format).bytes;
        const SquareOffsets<bytes> at(level, square);
        StoredTexels<bytes> texels[4];
#pragma GCC unroll 4
        for (int i = 0; i < 4; ++i) texels[i] = stored_texels<bytes>(level.texels, at.offsets[i]);
#pragma GCC unroll 4
        for (int k = 0; k < 4; ++k)
          value[k] =
              blend(decoded_component<float, format>(texels[0], k), decoded_component<float, format>(texels[1], k),
                    decoded_component<float, format>(texels[2], k), decoded_component<float, format>(texels[3], k));
      });
  if (is_done) return value;
  const auto texel = [&](int column, int row) {
    return texels_at<float>(level, square.columns[column], square.rows[row]);
  };
  const auto a = texel(0, 0), b = texel(1, 0), c = texel(0, 1), d = texel(1, 1);
  for (int k = 0; k < 4; ++k) value[k] = blend(a[k], b[k], c[k], d[k]);
  return value;
}

}  // namespace tandem::kernel
