#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "rhi_cpu/kernel/sampling.hpp"
#include "rhi_cpu/kernel/wide/functions.hpp"
#include "rhi_cpu/kernel/wide/images.hpp"
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

/// What is the same for all texels that lanes read of one level.
template <typename C, Shape shape>
struct LanesReader {
  const Sampler& sampler;
  const TexelLevel& level;
  glm::vec<4, C> border;
  Ints layer;

  int size(int side) const { return static_cast<int>(level.size[side]); }
  Floats scaled(const LookupOfLanes<shape>& lookup, int side) const {
    return sampler.unnormalized != 0 ? lookup.at[side] : lookup.at[side] * static_cast<float>(size(side));
  }
  Ints wrapped(const Ints& texel, int side) const { return kernel::wrapped(texel, size(side), sampler.address[side]); }
  NeighboursOfLanes neighbours(const LookupOfLanes<shape>& lookup, int side, int shift) const {
    const Floats from = scaled(lookup, side) - 0.5f;
    const Floats whole = kernel::floor(from);
    const Ints low = float_to_signed<Ints>(whole);
    return {wrapped(low + shift, side), wrapped(low + 1 + shift, side), from - whole};
  }
  /// The lanes whose texel is of the border.
  Mask is_outside(const Ints (&at)[sides_of(shape)]) const {
    Ints outside = at[0];
    for (int i = 1; i < sides_of(shape); ++i) outside |= at[i];
    return outside < Ints(0);
  }
  bool may_be_outside() const {
    bool may = false;
    for (int i = 0; i < sides_of(shape); ++i) may |= sampler.address[i] == AddressMode::clamp_to_border;
    return may;
  }
  /// read(x, row) of texels, and `of_border` in the lanes that are outside.
  template <typename Value, typename Read>
  Value read_or(const Ints (&at)[sides_of(shape)], const Value& of_border, const Read& read) const {
    Ints x = at[0], row = 0;
    if constexpr (shape == Shape::d1_array) row = layer;
    if constexpr (shape == Shape::d2) row = at[1];
    if constexpr (shape == Shape::d2_array) row = layer * size(1) + at[1];
    if constexpr (shape == Shape::d3) row = at[2] * size(1) + at[1];
    if (!may_be_outside()) return read(Words(x), Words(row));
    const Mask outside = is_outside(at);
    if (!any_of(outside)) return read(Words(x), Words(row));
    x = kernel::select(outside, Ints(0), x);
    row = kernel::select(outside, Ints(0), row);
    return kernel::select(outside, of_border, read(Words(x), Words(row)));
  }
  glm::vec<4, Lanes<C>> operator()(const Ints (&at)[sides_of(shape)]) const {
    return read_or(at, kernel::spread(border), [&](Words x, Words row) { return texels_at<C>(level, x, row); });
  }
  Lanes<C> component(const Ints (&at)[sides_of(shape)], int number) const {
    return read_or(at, Lanes<C>(border[number]),
                   [&](Words x, Words row) { return components_at<C>(level, x, row, number); });
  }
};

/// The linear filter over sides 0 to `side`.
template <int side, typename C, Shape shape>
inline glm::vec<4, Lanes<C>> blended(const NeighboursOfLanes (&neighbours)[sides_of(shape)],
                                     Ints (&at)[sides_of(shape)], const LanesReader<C, shape>& reader) {
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

template <typename C, Shape shape>
inline glm::vec<4, Lanes<C>> filtered_level(const LookupOfLanes<shape>& lookup, Filter filter,
                                            const LanesReader<C, shape>& reader) {
  constexpr int sides = sides_of(shape);
  Ints at[sides];
  if constexpr (std::is_floating_point_v<C>) {
    if (filter == Filter::linear) {
      NeighboursOfLanes neighbours[sides];
      for (int i = 0; i < sides; ++i) neighbours[i] = reader.neighbours(lookup, i, lookup.shift[i]);
      return blended<sides - 1>(neighbours, at, reader);
    }
  }
  for (int i = 0; i < sides; ++i)
    at[i] = reader.wrapped(float_to_signed<Ints>(kernel::floor(reader.scaled(lookup, i))) + lookup.shift[i], i);
  return reader(at);
}

/// The layers that there are.
template <Shape shape>
inline Ints layers_of(const Image& image, const LookupOfLanes<shape>& lookup) {
  if constexpr (!is_layered(shape)) return 0;
  const std::uint32_t layers = image.size[shape == Shape::d1_array ? 1 : 2];
  const float last = layers == 0 ? 0.0f : static_cast<float>(layers) - 1.0f;
  return Ints(kernel::clamp(kernel::round_even(lookup.layer), Floats(0.0f), Floats(last)));
}

/// The filter over a level, and where weights are above 0 over the next one. The weight of lanes is 0 where the image
/// has no further level.
template <typename C, Shape shape>
inline glm::vec<4, Lanes<C>> filtered_levels(const SampledImage& texture, const LookupOfLanes<shape>& lookup,
                                             Filter filter, std::uint32_t number, const Floats& weights) {
  const Image& image = *texture.image;
  const Sampler& sampler = *texture.sampler;
  const glm::vec<4, C> border = border_texel<C>(image, sampler);
  const Ints layer = layers_of(image, lookup);
  const auto of_level = [&](std::uint32_t each) {
    const TexelLevel level(image, each);
    return filtered_level(lookup, filter, LanesReader<C, shape>{sampler, level, border, layer});
  };
  const auto fine = of_level(number);
  if constexpr (std::is_floating_point_v<C>) {
    const Mask blends = weights > Floats(0.0f);
    if (any_of(blends)) return kernel::select(blends, fine + (of_level(number + 1) - fine) * weights, fine);
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

// What the translator calls.

template <typename C, Shape shape>
[[gnu::noinline]] inline glm::vec<4, Lanes<C>> sample(Mask mask, const SampledImage& texture,
                                                      const LookupOfLanes<shape>& lookup) {
  const Image& image = *texture.image;
  const Sampler& sampler = *texture.sampler;
  if (!lookup.have_details) {
    const Levels levels = levels_of(image, sampler, lookup.detail, 0.0f);
    return filtered_levels<C>(texture, lookup, levels.filter, levels.level, levels.weight);
  }
  // Lanes with the same filter and level together.
  const LevelsOfLanes levels(image, sampler, lookup.details);
  glm::vec<4, Lanes<C>> result = kernel::spread(glm::vec<4, C>(C(0)));
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

template <typename C, Shape shape>
[[gnu::noinline]] inline glm::vec<4, Lanes<C>> gather(const SampledImage& texture, const LookupOfLanes<shape>& lookup,
                                                      int component, const Array<ivec2, 4>* offsets = nullptr) {
  const Image& image = *texture.image;
  const TexelLevel level(image, 0);
  const LanesReader<C, shape> reader{*texture.sampler, level, border_texel<C>(image, *texture.sampler),
                                     layers_of(image, lookup)};
  glm::vec<4, Lanes<C>> values;
  if (offsets == nullptr) {
    constexpr ivec2 steps[4] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    const NeighboursOfLanes x = reader.neighbours(lookup, 0, lookup.shift[0]);
    const NeighboursOfLanes y = reader.neighbours(lookup, 1, lookup.shift[1]);
    for (int i = 0; i < 4; ++i)
      values[i] = reader.component({steps[i].x != 0 ? x.high : x.low, steps[i].y != 0 ? y.high : y.low}, component & 3);
    return values;
  }
  for (int i = 0; i < 4; ++i) {
    const ivec2 step = (*offsets)[static_cast<std::size_t>(i)];
    values[i] = reader.component({reader.neighbours(lookup, 0, lookup.shift[0] + step.x).low,
                                  reader.neighbours(lookup, 1, lookup.shift[1] + step.y).low},
                                 component & 3);
  }
  return values;
}

}  // namespace tandem::kernel
