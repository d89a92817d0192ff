#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "rhi_cpu/kernel/sampling.hpp"
#include "rhi_cpu/kernel/wide/functions.hpp"
#include "rhi_cpu/kernel/wide/levels.hpp"
#include "rhi_cpu/kernel/wide/texels.hpp"

/// Sampled images of all lanes at once: the twins of what kernel/sampling.hpp has, for one image, one sampler and
/// shapes other than cubes. Every operation is done in the order in which it is done there, so the bits are the same.
namespace tandem::kernel {

/// Where the lanes sample.
template <Shape shape>
struct LookupOfLanes {
  static constexpr int sides = sides_of(shape);
  Floats at[sides];
  Floats layer = 0.0f;
  float detail = 0.0f;    ///< Lod, where lanes have it in common
  Floats details = 0.0f;  ///< else
  bool have_details = false;
  int shift[sides] = {};  ///< ConstOffset

  LookupOfLanes& at_detail(float level) {
    detail = level;
    return *this;
  }
  LookupOfLanes& at_detail(const Floats& levels) {
    details = levels;
    have_details = true;
    return *this;
  }
  template <typename Offset>
  LookupOfLanes& shifted(const Offset& offset) {
    const ivec3 steps = widened<ivec3>(offset);
    for (int i = 0; i < sides; ++i) shift[i] = steps[i];
    return *this;
  }
};

/// Coordinates, behind which stands the layer of an array.
template <Shape shape, typename Coordinate>
inline LookupOfLanes<shape> lookup_of_lanes(const Coordinate& coordinate) {
  LookupOfLanes<shape> result;
  if constexpr (length_of<Coordinate> == 0) {
    result.at[0] = coordinate;
  } else {
    for (int i = 0; i < sides_of(shape); ++i) result.at[i] = coordinate[i];
    if constexpr (is_layered(shape)) result.layer = coordinate[sides_of(shape)];
  }
  return result;
}

/// Homogeneous coordinates.
template <Shape shape, typename Coordinate>
inline LookupOfLanes<shape> projected_of_lanes(const Coordinate& coordinate) {
  LookupOfLanes<shape> result;
  for (int i = 0; i < sides_of(shape); ++i) result.at[i] = coordinate[i] / coordinate[sides_of(shape)];
  return result;
}

/// n modulo `by`, not negative; `by` is positive and at most 2^16.
inline Ints modulo(const Ints& n, int by) {
  if (std::has_single_bit(static_cast<unsigned>(by))) return n & Ints(by - 1);
  // A quotient in floats is wrong by 2^-22 of itself, and so leaves a remainder of less than 2^18, whose quotient is
  // wrong by one at most.
  const float inverse = 1.0f / static_cast<float>(by);
  Ints rest = n;
  for (int round = 0; round < 2; ++round) {
    const Floats quotient = kernel::floor(Floats(rest) * inverse);
    rest -= Ints(quotient) * by;
  }
  rest = kernel::select(rest < Ints(0), rest + by, rest);
  return kernel::select(rest >= Ints(by), rest - by, rest);
}

inline Ints wrapped(const Ints& i, int size, AddressMode mode) {
  const Mask is_inside = Words(i) < Words(static_cast<std::uint32_t>(size));
  if (bits_of(is_inside) == all_bits) return i;
  switch (mode) {
    case AddressMode::repeat:
      return modulo(i, size);
    case AddressMode::mirrored_repeat: {
      const Ints n = modulo(i, 2 * size);
      return kernel::select(n < Ints(size), n, 2 * size - 1 - n);
    }
    case AddressMode::clamp_to_edge:
      return kernel::clamp(i, Ints(0), Ints(size - 1));
    case AddressMode::clamp_to_border:
      return kernel::select(is_inside, i, Ints(-1));
    case AddressMode::mirror_clamp_to_edge:
      return kernel::min(kernel::select(i < Ints(0), -(1 + i), i), Ints(size - 1));
  }
  return -1;
}

/// Neighbours of all lanes along a side, wrapped.
struct NeighboursOfLanes {
  Ints low, high;
  Floats weight;
};

template <Shape shape>
inline TexelLevel level_of_shape(const Image& image, std::uint32_t number) {
  const auto side = [&](int i) {
    return i < sides_of(shape) ? kernel::max(image.size[i] >> number, 1u) : image.size[i];
  };
  return {image, number, uvec3(side(0), side(1), side(2))};
}

/// The layers that there are.
template <Shape shape>
inline Ints layers_of(const Image& image, const LookupOfLanes<shape>& lookup) {
  if constexpr (!is_layered(shape)) return 0;
  const std::uint32_t layers = image.size[shape == Shape::d1_array ? 1 : 2];
  const float last = layers == 0 ? 0.0f : static_cast<float>(layers) - 1.0f;
  return Ints(kernel::clamp(kernel::round_even(lookup.layer), Floats(0.0f), Floats(last)));
}

/// Reads texels of one level of an image, or of its border.
template <typename C, Shape shape>
struct LanesReader {
  static constexpr int sides = sides_of(shape);
  using Place = Ints[sides];

  const Image& image;
  const Sampler& sampler;
  const LookupOfLanes<shape>& lookup;
  TexelLevel level;
  Ints layer;

  LanesReader(const SampledImage& texture, const LookupOfLanes<shape>& where, std::uint32_t number)
      : image(*texture.image),
        sampler(*texture.sampler),
        lookup(where),
        level(level_of_shape<shape>(image, number)),
        layer(layers_of(image, where)) {}

  int size(int side) const { return static_cast<int>(level.size[side]); }
  Floats scaled(int side) const {
    return sampler.unnormalized != 0 ? lookup.at[side] : lookup.at[side] * static_cast<float>(size(side));
  }
  Ints wrapped(const Ints& texel, int side) const { return kernel::wrapped(texel, size(side), sampler.address[side]); }
  NeighboursOfLanes neighbours(int side, int shift) const {
    const Floats from = scaled(side) - 0.5f;
    const Floats whole = kernel::floor(from);
    const Ints low = float_to_signed<Ints>(whole);
    return {wrapped(low + shift, side), wrapped(low + 1 + shift, side), from - whole};
  }
  Ints row(const Place& at) const {
    if constexpr (shape == Shape::d1) return 0;
    if constexpr (shape == Shape::d1_array) return layer;
    if constexpr (shape == Shape::d2) return at[1];
    if constexpr (shape == Shape::d2_array) return layer * size(1) + at[1];
    if constexpr (shape == Shape::d3) return at[2] * size(1) + at[1];
  }
  /// The lanes whose texel is of the border.
  Mask outside(const Place& at) const {
    bool may_be = false;
    Ints signs = 0;
#pragma GCC unroll 3
    for (int i = 0; i < sides; ++i) {
      may_be |= sampler.address[i] == AddressMode::clamp_to_border;
      signs |= at[i];
    }
    return may_be ? signs < Ints(0) : Mask(false);
  }
  /// read(x, row), or in the lanes that are outside of_border(texel of the border).
  template <typename Read, typename OfBorder>
  auto read_or(const Place& at, const Read& read, const OfBorder& of_border) const {
    const Mask is_outside = outside(at);
    if (!any_of(is_outside)) [[likely]]
      return read(Words(at[0]), Words(row(at)));
    const auto inside = read(kernel::select(is_outside, Words(0u), Words(at[0])),
                             kernel::select(is_outside, Words(0u), Words(row(at))));
    return kernel::select(is_outside, of_border(border_texel<C>(image, sampler)), inside);
  }
  glm::vec<4, Lanes<C>> operator()(const Place& at) const {
    return read_or(
        at, [&](Words x, Words row) { return texels_at<C>(level, x, row); },
        [](const glm::vec<4, C>& border) { return kernel::spread(border); });
  }
  /// Texels at (x, y) of the neighbours, which those of a further side lie before. @return whether all are inside
  bool square(const NeighboursOfLanes& x, const NeighboursOfLanes& y, const Place& at, SquareOfLanes& found) const {
    Place low, high;
#pragma GCC unroll 3
    for (int i = 0; i < sides; ++i) low[i] = high[i] = at[i];
    low[0] = x.low, low[1] = y.low, high[0] = x.high, high[1] = y.high;
    found = {{Words(x.low), Words(x.high)}, {Words(row(low)), Words(row(high))}};
    return !any_of(outside(low) || outside(high));
  }
};

/// The linear filter over sides 0 to `side`.
template <int side, typename C, Shape shape>
inline glm::vec<4, Lanes<C>> blended(const NeighboursOfLanes (&neighbours)[sides_of(shape)],
                                     Ints (&at)[sides_of(shape)], const LanesReader<C, shape>& reader) {
  if constexpr (side == 1)
    if (SquareOfLanes square; reader.square(neighbours[0], neighbours[1], at, square)) [[likely]]
      return blended_square(reader.level, square, neighbours[0].weight, neighbours[1].weight);
  if constexpr (side < 0) {
    return reader(at);
  } else {
    at[side] = neighbours[side].low;
    const auto low = blended<side - 1>(neighbours, at, reader);
    at[side] = neighbours[side].high;
    const auto high = blended<side - 1>(neighbours, at, reader);
    return low + (high - low) * neighbours[side].weight;
  }
}

/// The filter over one level.
template <typename C, Shape shape>
[[gnu::noinline]] inline glm::vec<4, Lanes<C>> filtered_level(const SampledImage& texture,
                                                              const LookupOfLanes<shape>& lookup, Filter filter,
                                                              std::uint32_t number) {
  constexpr int sides = sides_of(shape);
  const LanesReader<C, shape> reader(texture, lookup, number);
  Ints at[sides];
  if constexpr (std::is_floating_point_v<C>) {
    if (filter == Filter::linear) {
      NeighboursOfLanes neighbours[sides];
#pragma GCC unroll 3
      for (int i = 0; i < sides; ++i) neighbours[i] = reader.neighbours(i, lookup.shift[i]);
      return blended<sides - 1>(neighbours, at, reader);
    }
  }
#pragma GCC unroll 3
  for (int i = 0; i < sides; ++i)
    at[i] = reader.wrapped(float_to_signed<Ints>(kernel::floor(reader.scaled(i))) + lookup.shift[i], i);
  return reader(at);
}

/// The filter over a level, and where weights are above 0 over the next one, which then exists.
template <typename C, Shape shape>
inline glm::vec<4, Lanes<C>> filtered_levels(const SampledImage& texture, const LookupOfLanes<shape>& lookup,
                                             Filter filter, std::uint32_t number, const Floats& weights) {
  glm::vec<4, Lanes<C>> fine = filtered_level<C>(texture, lookup, filter, number);
  if constexpr (std::is_floating_point_v<C>) {
    if (const Mask blends = weights > Floats(0.0f); any_of(blends)) {
      const glm::vec<4, Lanes<C>> coarse = filtered_level<C>(texture, lookup, filter, number + 1);
      fine = kernel::select(blends, fine + (coarse - fine) * weights, fine);
    }
  }
  return fine;
}

/// levels_of() of lanes that have details of their own.
struct LevelsOfLanes {
  Mask magnifies;
  Floats level;
  Floats weight;

  LevelsOfLanes(const Image& image, const Sampler& sampler, const Floats& detail) {
    const Floats limited =
        kernel::clamp(detail + sampler.lod_bias, Floats(kernel::max(sampler.min_lod, 0.0f)), Floats(sampler.max_lod));
    magnifies = limited <= Floats(0.0f);
    const Floats at = kernel::clamp(limited, Floats(0.0f), Floats(static_cast<float>(image.level_count - 1)));
    if (sampler.mipmap == Filter::nearest) {
      level = kernel::max(kernel::ceil(at + 0.5f) - 1.0f, Floats(0.0f));
      weight = 0.0f;
    } else {
      level = kernel::floor(at);
      weight = at - level;
    }
  }
};

/// sample() where lanes may need different levels, or different filters.
template <typename C, Shape shape>
[[gnu::noinline]] inline glm::vec<4, Lanes<C>> sample_levels(Mask mask, const SampledImage& texture,
                                                             const LookupOfLanes<shape>& lookup) {
  const Image& image = *texture.image;
  const Sampler& sampler = *texture.sampler;
  const LevelsOfLanes levels(image, sampler, lookup.have_details ? lookup.details : Floats(lookup.detail));
  glm::vec<4, Lanes<C>> result = kernel::spread(glm::vec<4, C>(C(0)));
  // Lanes with the same filter and level together.
  for (Mask left = mask; any_of(left);) {
    const int first = std::countr_zero(bits_of(left));
    const bool magnifies = levels.magnifies[first];
    const Mask alike = left && levels.level == Floats(levels.level[first]) && levels.magnifies == Mask(magnifies);
    const auto value = filtered_levels<C>(texture, lookup, magnifies ? sampler.magnification : sampler.minification,
                                          static_cast<std::uint32_t>(levels.level[first]),
                                          kernel::select(alike, levels.weight, Floats(0.0f)));
    result = kernel::select(alike, value, result);
    left = left && !alike;
  }
  return result;
}

// What the translator calls.

template <typename C, Shape shape>
[[gnu::noinline]] inline glm::vec<4, Lanes<C>> sample(Mask mask, const SampledImage& texture,
                                                      const LookupOfLanes<shape>& lookup) {
  const Sampler& sampler = *texture.sampler;
  const bool is_one_level = texture.image->level_count == 1 && sampler.magnification == sampler.minification;
  if (is_one_level) [[likely]]
    return filtered_level<C>(texture, lookup, sampler.magnification, 0);
  return sample_levels<C>(mask, texture, lookup);
}

template <typename C, Shape shape>
[[gnu::noinline]] inline glm::vec<4, Lanes<C>> gather(const SampledImage& texture, const LookupOfLanes<shape>& lookup,
                                                      int component, const Array<ivec2, 4>* offsets = nullptr) {
  const LanesReader<C, shape> reader(texture, lookup, 0);
  const auto texel = [&](const Ints& x, const Ints& y) { return reader({x, y})[component & 3]; };
  if (offsets == nullptr) {
    const NeighboursOfLanes x = reader.neighbours(0, lookup.shift[0]), y = reader.neighbours(1, lookup.shift[1]);
    if (SquareOfLanes square; reader.square(x, y, {}, square)) [[likely]]
      return components_of_square<C>(reader.level, square, component & 3);
    return {texel(x.low, y.high), texel(x.high, y.high), texel(x.high, y.low), texel(x.low, y.low)};
  }
  glm::vec<4, Lanes<C>> values;
  for (int i = 0; i < 4; ++i) {
    const ivec2 step = (*offsets)[static_cast<std::size_t>(i)];
    values[i] =
        texel(reader.neighbours(0, lookup.shift[0] + step.x).low, reader.neighbours(1, lookup.shift[1] + step.y).low);
  }
  return values;
}

}  // namespace tandem::kernel
