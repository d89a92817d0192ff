#pragma once

#include "base/json_value.hpp"

/// What the readers of a scene description share: values that know their place, and the ranges of numbers.
namespace tandem::pathtracer::description {

using json::fraction;
using json::Object;
using json::Range;
using json::type_of;
using json::Value;

/// Positions and lengths are at most this: where a ray meets a triangle is found from products of three coordinates,
/// which must be floats.
inline constexpr double largest_length = 1e12;
/// Radiances and factors are at most this, so that no product of a few of them overflows.
inline constexpr double largest_radiance = 1e9;

inline constexpr json::Range any_length{-largest_length, largest_length, false};
inline constexpr json::Range positive_length{0, largest_length, true};
inline constexpr json::Range radiance_range{0, largest_radiance, false};

}  // namespace tandem::pathtracer::description
