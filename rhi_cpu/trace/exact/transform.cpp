#include "rhi_cpu/trace/exact/transform.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "rhi_cpu/trace/exact/exact_number.hpp"

namespace tandem::cpu::exact {

Transform make_transform(const float (&rows)[3][4]) {
  Transform result{.rows = {}, .is_identity = true, .determinant_sign = 0};
  std::memcpy(result.rows, rows, sizeof(rows));
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      result.is_identity = result.is_identity && rows[row][column] == (row == column ? 1.0f : 0.0f);
    }
  }
  result.determinant_sign = adjugate_of<ExactNumber>(result).determinant.sign();
  return result;
}

Bounds to_world(const Transform& transform, const Bounds& bounds) {
  if (transform.is_identity) return bounds;
  Bounds result;
  for (std::size_t i = 0; i < 3; ++i) {
    const float(&row)[4] = transform.rows[i];
    double lower = double{row[3]};
    double upper = lower;
    double magnitude = std::abs(lower);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // Exact: bounds in object space are floats.
      const double a = double{row[axis]} * bounds.lower[axis];
      const double b = double{row[axis]} * bounds.upper[axis];
      lower += std::min(a, b);
      upper += std::max(a, b);
      magnitude += std::max(std::abs(a), std::abs(b));
    }
    // Three sums lose at most 2^-53 of the magnitude each.
    result.lower[i] = lower - magnitude * 0x1p-50;
    result.upper[i] = upper + magnitude * 0x1p-50;
  }
  return result;
}

RayLine to_object(const Transform& transform, const Vector<BoundedNumber>& origin,
                  const Vector<BoundedNumber>& direction) {
  if (transform.is_identity) return {origin, direction};
  const Adjugate<BoundedNumber> adjugate = adjugate_of<BoundedNumber>(transform);
  const Vector<BoundedNumber> translation(transform.rows[0][3], transform.rows[1][3], transform.rows[2][3]);
  const auto solve = [&](const Vector<BoundedNumber>& v) {
    return Vector<BoundedNumber>(dot(adjugate.rows[0], v) / adjugate.determinant,
                                 dot(adjugate.rows[1], v) / adjugate.determinant,
                                 dot(adjugate.rows[2], v) / adjugate.determinant);
  };
  return {solve(origin - translation), solve(direction)};
}

}  // namespace tandem::cpu::exact
