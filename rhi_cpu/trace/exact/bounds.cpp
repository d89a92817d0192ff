#include "rhi_cpu/trace/exact/bounds.hpp"

namespace tandem::cpu::exact {

RayLine::RayLine(const Vector<BoundedNumber>& origin, const Vector<BoundedNumber>& direction)
    : axes_{axis_of(origin.x, direction.x), axis_of(origin.y, direction.y), axis_of(origin.z, direction.z)} {}

RayLine::Axis RayLine::axis_of(const BoundedNumber& origin, const BoundedNumber& direction) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Axis axis{.origin = origin.value(),
            .reciprocal = 0,
            .is_parallel = sign_of(direction) == 0,
            .relative_error = 0,
            .absolute_error = infinity};
  // Distances to a plane are rounded, by 2^-53 of what they are.
  if (axis.is_parallel) axis.absolute_error = origin.error() * (1 + 0x1p-48);
  // A direction that may or may not be parallel does not restrict t.
  if (sign_of(direction).value_or(0) == 0) return axis;
  const double least = std::abs(direction.value()) - direction.error();
  axis.reciprocal = 1 / direction.value();
  // The distance, the reciprocal and their product are rounded by 2^-53 each. A t that is too small for double is
  // covered by the last term; one that is too large becomes a NaN, which restricts nothing.
  axis.relative_error = direction.error() / least * (1 + 0x1p-48) + 0x1p-50;
  axis.absolute_error = origin.error() / least * (1 + 0x1p-48) + std::numeric_limits<double>::min();
  return axis;
}

}  // namespace tandem::cpu::exact
