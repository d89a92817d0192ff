#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "rhi_cpu/kernel/images.hpp"
#include "rhi_cpu/kernel/wide/functions.hpp"
#include "rhi_cpu/kernel/wide/levels.hpp"
#include "rhi_cpu/kernel/wide/memory.hpp"
#include "rhi_cpu/kernel/wide/texels.hpp"

/// Storage images and fetches of all lanes at once: the twins of kernel/images.hpp, of one image.
namespace tandem::kernel {

/// The texels of a level at a coordinate of one to three integers.
struct TexelsOfLanes {
  Mask inside;  ///< the lanes of the mask whose texel the level has
  Words x, row;

  template <typename Coordinate>
  TexelsOfLanes(Mask mask, const TexelLevel& level, const Coordinate& coordinate) : inside(mask), row(0u) {
    if constexpr (length_of<Coordinate> == 0) {
      place(0, coordinate, level);
    } else {
      // Rows are counted through all layers.
      for (int i = length_of<Coordinate> - 1; i >= 0; --i) place(i, coordinate[i], level);
    }
    // A level without texels has none for z either.
    for (int i = length_of<Coordinate> == 0 ? 1 : length_of<Coordinate>; i < 3; ++i)
      inside = inside && Mask(level.size[i] != 0);
    // Others read where one inside reads.
    if (const std::uint32_t bits = bits_of(inside); bits != all_bits && bits != 0) {
      const int any = std::countr_zero(bits);
      x = kernel::select(inside, x, Words(x[any]));
      row = kernel::select(inside, row, Words(row[any]));
    }
  }

 private:
  template <typename T>
  void place(int side, const Lanes<T>& coordinate, const TexelLevel& level) {
    const Words at = Words(coordinate);
    inside = inside && at < Words(level.size[side]);
    if (side == 0)
      x = at;
    else
      row = side == 2 ? at * Words(level.size.y) : row + at;
  }
};

/// The texels of `place`, of a format that is known when the shader runs, and nothing_of() outside.
template <typename C>
inline glm::vec<4, Lanes<C>> texels_of(const TexelLevel& level, const TexelsOfLanes& place) {
  const auto nothing = kernel::spread(nothing_of<C>(level.format));
  if (!any_of(place.inside)) return nothing;
  return kernel::select(place.inside, texels_at<C>(level, place.x, place.row), nothing);
}

/// Whether texels of the format become components of type C in lanes.
template <typename C, TexelFormat format>
inline constexpr bool converts_in_lanes = has_lanes(format) &&
                                          holds_integers(layout_of(format).coding) != std::is_floating_point_v<C>;

/// Level 0, where a storage image is read and written; without texels where nothing is bound.
template <TexelFormat format>
inline TexelLevel storage_level(const Image* image) {
  return {*image, 0, uvec3(image->size[0], image->size[1], image->size[2]), texel_bytes<format>(image)};
}

/// Texels of any format, from lane to lane.
template <typename C, TexelFormat format>
[[gnu::noinline]] inline glm::vec<4, Lanes<C>> decoded_by_lane(const TexelLevel& level, Words x, Words row) {
  glm::vec<4, Lanes<C>> value;
  for (int i = 0; i < lane_count; ++i) kernel::set_lane(value, i, decode<C, format>(level.texel(x[i], row[i])));
  return value;
}
template <typename C, TexelFormat format>
[[gnu::noinline]] inline void encode_by_lane(Mask mask, const TexelLevel& level, Words x, Words row,
                                             const glm::vec<4, Lanes<C>>& value) {
  for (const int lane : EachLane(mask)) {
    std::byte* texel = level.texel(x[lane], row[lane]);
    if constexpr (format == TexelFormat::of_the_image)
      encoders<C>[level.format](texel, kernel::lane(value, lane));
    else
      encode<C, format>(texel, kernel::lane(value, lane));
  }
}

/// imageLoad.
template <typename C, TexelFormat format, typename Coordinate>
inline glm::vec<4, Lanes<C>> image_load(Mask mask, const Image* image, const Coordinate& coordinate) {
  const TexelLevel level = storage_level<format>(image);
  const TexelsOfLanes place(mask, level, coordinate);
  if constexpr (format == TexelFormat::of_the_image) {
    return texels_of<C>(level, place);
  } else {
    const auto nothing = kernel::spread(nothing_of<C>(static_cast<std::uint32_t>(format)));
    if (!any_of(place.inside)) return nothing;
    if constexpr (converts_in_lanes<C, format>) {
      if (level.is_small) [[likely]] {
        constexpr std::uint32_t bytes = layout_of(format).bytes;
        const auto texels = stored_texels<bytes>(level.texels, level.offsets(place.x, place.row, bytes));
        return kernel::select(place.inside, decoded<C, format>(texels), nothing);
      }
    }
    return kernel::select(place.inside, decoded_by_lane<C, format>(level, place.x, place.row), nothing);
  }
}

/// imageStore.
template <typename C, TexelFormat format, typename Coordinate>
inline void image_store(Mask mask, const Image* image, const Coordinate& coordinate,
                        const glm::vec<4, Lanes<C>>& value) {
  const TexelLevel level = storage_level<format>(image);
  const TexelsOfLanes place(mask, level, coordinate);
  const auto store = [&]<TexelFormat known>() {
    store_texels(place.inside, level.texels, level.offsets(place.x, place.row, layout_of(known).bytes),
                 encoded<C, known>(value));
  };
  if constexpr (format == TexelFormat::of_the_image) {
    if (level.is_small && of_common_format<C>(level.format, store)) return;
  } else if constexpr (converts_in_lanes<C, format>) {
    if (level.is_small) [[likely]]
      return store.template operator()<format>();
  }
  encode_by_lane<C, format>(place.inside, level, place.x, place.row, value);
}

/// texelFetch of one level for all lanes.
template <typename C, typename Coordinate>
inline glm::vec<4, Lanes<C>> fetch(Mask mask, const Image* image, const Coordinate& coordinate, std::uint32_t level = 0,
                                   const ivec3& shift = ivec3(0)) {
  if (level >= image->level_count) return kernel::spread(nothing_of<C>(image->format));
  const TexelLevel texels(*image, level, level_size(image, level));
  Coordinate at = coordinate;
  if constexpr (length_of<Coordinate> == 0)
    at += shift.x;
  else
    for (int i = 0; i < length_of<Coordinate>; ++i) at[i] += shift[i];
  return texels_of<C>(texels, TexelsOfLanes(mask, texels, at));
}

}  // namespace tandem::kernel
