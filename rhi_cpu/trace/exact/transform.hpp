#pragma once

#include <span>

#include "rhi_cpu/trace/exact/bounds.hpp"
#include "rhi_cpu/trace/exact/vector.hpp"

namespace tandem::cpu::exact {

/// From the object space of an instance to world space.
///
/// The tracer works in world space. There the ray is what the shader gave, and a vertex is a polynomial in floats, so
/// that both are known exactly; the inverse that would take the ray to object space is not one, and would round. A
/// vertex that triangles share is the same point for all of them.
struct Transform {
  float rows[3][4];  ///< row-major
  bool is_identity;
  int determinant_sign;  ///< exactly: -1, 0 or 1
};

/// @param rows finite
Transform make_transform(const float (&rows)[3][4]);

template <class Number>
Vector<Number> to_world(const Transform& transform, std::span<const float, 3> position) {
  if (transform.is_identity) return Vector<Number>(position);
  const auto coordinate = [&](const float(&row)[4]) {
    return Number(row[0]) * Number(position[0]) + Number(row[1]) * Number(position[1]) +
           Number(row[2]) * Number(position[2]) + Number(row[3]);
  };
  return {coordinate(transform.rows[0]), coordinate(transform.rows[1]), coordinate(transform.rows[2])};
}

/// Bounds in world space of everything inside of `bounds`, a little too large rather than too small.
Bounds to_world(const Transform& transform, const Bounds& bounds);

/// The rows of the adjugate of the transform's linear part: the determinant times its inverse.
template <class Number>
struct Adjugate {
  Vector<Number> rows[3];
  Number determinant;
};

template <class Number>
Adjugate<Number> adjugate_of(const Transform& transform) {
  const auto& m = transform.rows;
  const auto column = [&](int i) { return Vector<Number>(Number(m[0][i]), Number(m[1][i]), Number(m[2][i])); };
  const Vector<Number> x = column(0), y = column(1), z = column(2);
  return {.rows = {cross(y, z), cross(z, x), cross(x, y)}, .determinant = dot(x, cross(y, z))};
}

/// A ray of world space against bounds of object space.
RayLine to_object(const Transform& transform, const Vector<BoundedNumber>& origin,
                  const Vector<BoundedNumber>& direction);

}  // namespace tandem::cpu::exact
