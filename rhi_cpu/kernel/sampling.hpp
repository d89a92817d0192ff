#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/kernel/cube.hpp"
#include "rhi_cpu/kernel/images.hpp"
#include "rhi_cpu/kernel/math.hpp"
#include "rhi_cpu/kernel/samplers.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// Sampled images: Vulkan's chapter "Image Operations", with weights in full precision. The translator includes this
/// file where a shader samples.
namespace tandem::kernel {

constexpr bool is_cube(Shape shape) { return shape == Shape::cube || shape == Shape::cube_array; }
constexpr bool is_layered(Shape shape) { return shape >= Shape::d1_array; }
/// Sides of a level, which for a cube are those of a face.
constexpr int sides_of(Shape shape) {
  return shape == Shape::d1 || shape == Shape::d1_array ? 1 : shape == Shape::d3 ? 3 : 2;
}
/// Coordinates before the layer.
constexpr int coordinates_of(Shape shape) { return is_cube(shape) ? 3 : sides_of(shape); }

/// The first components of a scalar or vector, then zeros.
template <typename V, typename T>
inline V widened(const T& value, int count = 3) {
  V result(0);
  if constexpr (length_of<T> == 0)
    result.x = static_cast<component_t<V>>(value);
  else
    for (int i = 0; i < length_of<T> && i < count; ++i) result[i] = static_cast<component_t<V>>(value[i]);
  return result;
}

/// Where a shader samples: coordinates and image operands.
struct Lookup {
  vec3 at = vec3(0.0f);
  float layer = 0.0f;
  float detail = 0.0f;  ///< Lod, where there are no gradients
  bool has_gradients = false;
  vec3 dx = vec3(0.0f);
  vec3 dy = vec3(0.0f);
  float least_detail = 0.0f;  ///< MinLod
  ivec3 shift = ivec3(0);     ///< Offset, ConstOffset

  Lookup& at_detail(float level) {
    detail = level;
    return *this;
  }
  template <typename Gradient>
  Lookup& with_gradients(const Gradient& along_x, const Gradient& along_y) {
    has_gradients = true;
    dx = widened<vec3>(along_x);
    dy = widened<vec3>(along_y);
    return *this;
  }
  Lookup& not_finer_than(float level) {
    least_detail = level;
    return *this;
  }
  template <typename Offset>
  Lookup& shifted(const Offset& offset) {
    shift = widened<ivec3>(offset);
    return *this;
  }
};

/// Coordinates, behind which stands the layer of an array.
template <Shape shape, typename Coordinate>
inline Lookup lookup(const Coordinate& coordinate) {
  Lookup result;
  result.at = widened<vec3>(coordinate, coordinates_of(shape));
  if constexpr (is_layered(shape)) result.layer = coordinate[coordinates_of(shape)];
  return result;
}

/// Homogeneous coordinates.
template <Shape shape, typename Coordinate>
inline Lookup projected(const Coordinate& coordinate) {
  Lookup result;
  result.at = widened<vec3>(coordinate, sides_of(shape)) / coordinate[sides_of(shape)];
  return result;
}

/// A lookup in an image: on a face of a cube, in a layer that there is.
struct Place {
  vec3 at = vec3(0.0f);  ///< as the shader gives it; of a cube, on the face
  int layer = 0;         ///< of the image's data
  int face = 0;
  float detail = 0.0f;
};

/// log2 of the texels of level 0 that a step of one pixel passes.
inline float detail_of_gradients(const Image& image, int sides, const vec3& dx, const vec3& dy) {
  vec3 size(0.0f);
  for (int i = 0; i < sides; ++i) size[i] = static_cast<float>(image.size[i]);
  const vec3 x = dx * size, y = dy * size;
  const float square = kernel::max(x.x * x.x + x.y * x.y + x.z * x.z, y.x * y.x + y.y * y.y + y.z * y.z);
  return kernel::log2(std::sqrt(square));
}

template <Shape shape>
inline Place place_of(const Image& image, const Lookup& lookup) {
  Place place = {.at = lookup.at, .detail = lookup.detail};
  vec3 dx = lookup.dx, dy = lookup.dy;
  if constexpr (is_cube(shape)) {
    place.face = face_of(lookup.at);
    place.at = vec3(place_on_face(place.face, lookup.at), 0.0f);
    if (lookup.has_gradients) {
      dx = vec3(change_on_face(place.face, lookup.at, lookup.dx), 0.0f);
      dy = vec3(change_on_face(place.face, lookup.at, lookup.dy), 0.0f);
    }
  }
  if (lookup.has_gradients) place.detail = detail_of_gradients(image, sides_of(shape), dx, dy);
  if constexpr (is_layered(shape)) {
    const std::uint32_t layers = image.size[shape == Shape::d1_array ? 1 : 2] / (is_cube(shape) ? 6u : 1u);
    const float last = layers == 0 ? 0.0f : static_cast<float>(layers) - 1.0f;  // 0: an image that stands for none
    place.layer = static_cast<int>(kernel::clamp(kernel::round_even(lookup.layer), 0.0f, last));
  }
  if constexpr (is_cube(shape)) place.layer *= 6;
  return place;
}

/// read(texel) for texels of one level of an image, or of its border.
template <typename C, Shape shape, typename Read>
struct LevelReader {
  Level<C> level;
  glm::vec<4, C> border;
  int layer;
  const Read& read;

  auto operator()(ivec3 at) const {
    if (at.x < 0 || at.y < 0 || at.z < 0) return read(border);
    if constexpr (shape == Shape::d1_array)
      at.y = layer;
    else if constexpr (shape != Shape::d3)
      at.z += layer;  // to the face of a cube
    return read(level[at]);
  }
};

/// The coordinate in texels.
inline float scaled(float coordinate, int size, const Sampler& sampler) {
  return sampler.unnormalized != 0 ? coordinate : coordinate * static_cast<float>(size);
}

/// Neighbours along a side, wrapped.
inline Neighbours neighbours_on_side(const Place& place, const ivec3& shift, const ivec3& size, const Sampler& sampler,
                                     int side) {
  const Neighbours n = neighbours_of(scaled(place.at[side], size[side], sampler));
  const AddressMode mode = sampler.address[side];
  return {wrapped(n.low + shift[side], size[side], mode), wrapped(n.high + shift[side], size[side], mode), n.weight};
}

/// The linear filter over sides 0 to `side`.
template <int side, typename Reader>
inline auto blended(const std::array<Neighbours, 3>& sides, ivec3 at, const Reader& reader) {
  if constexpr (side < 0) {
    return reader(at);
  } else {
    at[side] = sides[side].low;
    const auto low = blended<side - 1>(sides, at, reader);
    at[side] = sides[side].high;
    const auto high = blended<side - 1>(sides, at, reader);
    return low + (high - low) * sides[side].weight;
  }
}

/// The four texels of a linear filter on a face of a cube, and the weights.
template <typename Reader>
inline auto square_on_face(const Place& place, int size, const Reader& reader, vec2& weight) {
  const Neighbours x = neighbours_of(place.at.x * static_cast<float>(size));
  const Neighbours y = neighbours_of(place.at.y * static_cast<float>(size));
  weight = vec2(x.weight, y.weight);
  return square_of_cube(place.face, kernel::clamp(x.low, -1, size - 1), kernel::clamp(y.low, -1, size - 1), size,
                        reader);
}

template <Shape shape, typename Reader>
inline auto filtered_nearest(const Place& place, const ivec3& shift, const Sampler& sampler, const Reader& reader) {
  const ivec3& size = reader.level.size;
  ivec3 at(0);
  for (int i = 0; i < sides_of(shape); ++i) {
    const int texel = float_to_signed<int>(kernel::floor(scaled(place.at[i], size[i], sampler)));
    at[i] = wrapped(texel + shift[i], size[i], is_cube(shape) ? AddressMode::clamp_to_edge : sampler.address[i]);
  }
  if constexpr (is_cube(shape)) at.z = place.face;
  return reader(at);
}

template <Shape shape, typename Reader>
inline auto filtered_linear(const Place& place, const ivec3& shift, const Sampler& sampler, const Reader& reader) {
  const ivec3& size = reader.level.size;
  if constexpr (is_cube(shape)) {
    vec2 weight;
    const auto square = square_on_face(place, size.x, reader, weight);
    const auto low = square[0] + (square[1] - square[0]) * weight.x;
    const auto high = square[2] + (square[3] - square[2]) * weight.x;
    return low + (high - low) * weight.y;
  } else {
    std::array<Neighbours, 3> sides = {};
    for (int i = 0; i < sides_of(shape); ++i)
      sides[static_cast<std::size_t>(i)] = neighbours_on_side(place, shift, size, sampler, i);
    return blended<sides_of(shape) - 1>(sides, ivec3(0), reader);
  }
}

/// The filter over read(texel). Integers have no linear filter.
template <typename C, Shape shape, typename Read>
inline auto filtered(const SampledImage& texture, const Lookup& lookup, const Read& read) {
  const Image& image = *texture.image;
  const Sampler& sampler = *texture.sampler;
  const Place place = place_of<shape>(image, lookup);
  const Levels levels = levels_of(image, sampler, place.detail, lookup.least_detail);
  const glm::vec<4, C> border = border_texel<C>(image, sampler);
  const auto of_level = [&](std::uint32_t number) {
    const LevelReader<C, shape, Read> reader = {Level<C>(image, number), border, place.layer, read};
    if constexpr (std::is_floating_point_v<C>)
      if (levels.filter == Filter::linear) return filtered_linear<shape>(place, lookup.shift, sampler, reader);
    return filtered_nearest<shape>(place, lookup.shift, sampler, reader);
  };
  const auto fine = of_level(levels.level);
  if constexpr (std::is_floating_point_v<C>)
    if (levels.weight > 0.0f) return fine + (of_level(levels.level + 1) - fine) * levels.weight;
  return fine;
}

/// read(texel) of the four texels of a linear filter at level 0, in the order of a gather: (x, y + 1), (x + 1, y + 1),
/// (x + 1, y), (x, y). Each of four offsets gives the texel (x, y) at it.
template <typename C, Shape shape, typename Read>
inline auto gathered(const SampledImage& texture, const Lookup& lookup, const Array<ivec2, 4>* offsets,
                     const Read& read) {
  const Image& image = *texture.image;
  const Sampler& sampler = *texture.sampler;
  const Place place = place_of<shape>(image, lookup);
  const LevelReader<C, shape, Read> reader = {Level<C>(image, 0), border_texel<C>(image, sampler), place.layer, read};
  using Value = decltype(read(reader.border));
  if constexpr (is_cube(shape)) {
    vec2 weight;
    const auto square = square_on_face(place, reader.level.size.x, reader, weight);
    return glm::vec<4, Value>(square[2], square[3], square[1], square[0]);
  } else {
    constexpr ivec2 steps[4] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    glm::vec<4, Value> values(0);
    for (int i = 0; i < 4; ++i) {
      const ivec2 step = offsets == nullptr ? steps[i] : (*offsets)[static_cast<std::size_t>(i)];
      const ivec3 shift = lookup.shift + ivec3(step, 0);
      values[i] = reader({neighbours_on_side(place, shift, reader.level.size, sampler, 0).low,
                          neighbours_on_side(place, shift, reader.level.size, sampler, 1).low, 0});
    }
    return values;
  }
}

/// The depth that is compared: fixed point limits it.
inline float limited_reference(const Image& image, float reference) {
  return layout_of(static_cast<TexelFormat>(image.format)).coding == Coding::unorm
             ? kernel::clamp(reference, 0.0f, 1.0f)
             : reference;
}

// What the translator calls. Each is long, and a shader may call it often.

template <typename C, Shape shape>
[[gnu::noinline]] inline glm::vec<4, C> sample(const SampledImage& texture, const Lookup& lookup) {
  return filtered<C, shape>(texture, lookup, [](const glm::vec<4, C>& texel) { return texel; });
}

/// Of each texel whether `reference` passes, then filtered.
template <Shape shape>
[[gnu::noinline]] inline float sample_compare(const SampledImage& texture, const Lookup& lookup, float reference) {
  const float limited = limited_reference(*texture.image, reference);
  return filtered<float, shape>(
      texture, lookup, [&](const vec4& texel) { return compare_depth(texture.sampler->compare, limited, texel.x); });
}

template <typename C, Shape shape>
[[gnu::noinline]] inline glm::vec<4, C> gather(const SampledImage& texture, const Lookup& lookup, int component,
                                               const Array<ivec2, 4>* offsets = nullptr) {
  return gathered<C, shape>(texture, lookup, offsets,
                            [=](const glm::vec<4, C>& texel) { return texel[component & 3]; });
}

template <Shape shape>
[[gnu::noinline]] inline vec4 gather_compare(const SampledImage& texture, const Lookup& lookup, float reference,
                                             const Array<ivec2, 4>* offsets = nullptr) {
  const float limited = limited_reference(*texture.image, reference);
  return gathered<float, shape>(texture, lookup, offsets, [&](const vec4& texel) {
    return compare_depth(texture.sampler->compare, limited, texel.x);
  });
}

/// texelFetch: the texel at an integer coordinate; outside of the image and its levels nothing_of().
template <typename C, typename Coordinate>
inline glm::vec<4, C> fetch(const Image* image, const Coordinate& coordinate, std::uint32_t level = 0,
                            const ivec3& shift = ivec3(0)) {
  const uvec3 at(widened<ivec3>(coordinate) + shift);
  const uvec3 size = level_size(image, level);
  if (at.x >= size.x || at.y >= size.y || at.z >= size.z) return nothing_of<C>(image->format);
  return Level<C>(*image, level)[ivec3(at)];
}

}  // namespace tandem::kernel
