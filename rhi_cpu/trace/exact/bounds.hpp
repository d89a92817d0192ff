#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "rhi_cpu/trace/exact/bounded_number.hpp"
#include "rhi_cpu/trace/exact/vector.hpp"

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

/// A ray in the space of some bounds, as it is tested against them.
class RayLine {
 public:
  RayLine(const Vector<BoundedNumber>& origin, const Vector<BoundedNumber>& direction);

  /// A t that is not behind the first in the interval at which the ray is in the bounds; infinity when there is
  /// certainly none.
  double entry_into(const Bounds& bounds, const Interval& interval) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double first = interval.first;
    double last = interval.last;
    for (std::size_t i = 0; i < 3; ++i) {
      const Axis& axis = axes_[i];
      const double to_lower = bounds.lower[i] - axis.origin;
      const double to_upper = bounds.upper[i] - axis.origin;
      if (axis.is_parallel) {
        if (to_lower > axis.absolute_error || to_upper < -axis.absolute_error) return infinity;
        continue;
      }
      const double a = to_lower * axis.reciprocal;
      const double b = to_upper * axis.reciprocal;
      const double enter = std::min(a, b);
      const double exit = std::max(a, b);
      first = std::max(first, enter - (std::abs(enter) * axis.relative_error + axis.absolute_error));
      last = std::min(last, exit + (std::abs(exit) * axis.relative_error + axis.absolute_error));
    }
    if (first <= last) return first;
    return infinity;
  }

 private:
  struct Axis {
    double origin;
    double reciprocal;      ///< of the direction
    bool is_parallel;       ///< to the planes of this axis, exactly
    double relative_error;  ///< of a t
    double absolute_error;  ///< of a t, or of a position if parallel
  };

  static Axis axis_of(const BoundedNumber& origin, const BoundedNumber& direction);

  std::array<Axis, 3> axes_;
};

}  // namespace tandem::cpu::exact
