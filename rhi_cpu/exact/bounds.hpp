#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "rhi_cpu/kernel/trace.hpp"

namespace tandem::cpu::exact {

/// An axis-aligned box; empty by default.
struct Bounds {
  std::array<double, 3> lower = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::infinity()};
  std::array<double, 3> upper = {-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity()};

  void include(std::span<const float, 3> point) {
    for (std::size_t i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], double{point[i]});
      upper[i] = std::max(upper[i], double{point[i]});
    }
  }

  void include(const Bounds& other) {
    for (std::size_t i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], other.lower[i]);
      upper[i] = std::max(upper[i], other.upper[i]);
    }
  }
};

/// The closed interval of t in which hits are looked for.
struct Interval {
  double first;
  double last;
};

/// A ray as bounds are tested against it.
struct RayLine {
  explicit RayLine(const kernel::Ray& ray) {
    for (std::size_t i = 0; i < 3; ++i) {
      origin[i] = double{ray.origin[i]};
      direction[i] = double{ray.direction[i]};
      reciprocal[i] = 1 / direction[i];
    }
  }

  std::array<double, 3> origin;
  std::array<double, 3> direction;
  std::array<double, 3> reciprocal;
};

/// A t that is not behind the first in the interval at which the ray is in the bounds; infinity when there is certainly
/// none.
inline double entry_of(const RayLine& ray, const Bounds& bounds, const Interval& interval) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double first = interval.first;
  double last = interval.last;
  for (std::size_t i = 0; i < 3; ++i) {
    if (ray.direction[i] == 0) {
      if (ray.origin[i] < bounds.lower[i] || ray.origin[i] > bounds.upper[i]) return infinity;
      continue;
    }
    const double a = (bounds.lower[i] - ray.origin[i]) * ray.reciprocal[i];
    const double b = (bounds.upper[i] - ray.origin[i]) * ray.reciprocal[i];
    const double enter = std::min(a, b);
    const double exit = std::max(a, b);
    // Three roundings of 2^-53 each, of numbers that are neither too large for double nor, but for what the second term
    // covers, too small.
    first = std::max(first, enter - (std::abs(enter) * 0x1p-50 + std::numeric_limits<double>::min()));
    last = std::min(last, exit + (std::abs(exit) * 0x1p-50 + std::numeric_limits<double>::min()));
  }
  return first <= last ? first : infinity;
}

}  // namespace tandem::cpu::exact
