#pragma once

#include <array>
#include <glm/mat4x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "conformance/kit/scene.hpp"

/// What the answers must be, in doubles, from the same 32-bit inputs that the device gets.
namespace tandem::conformance {

/// An affine map in doubles: columns x, y, z and the translation.
glm::dmat4x3 matrix_of(const Transform& transform);
/// Rows of a matrix, rounded to floats.
Transform transform_of(const glm::dmat4x3& matrix);
/// The inverse of an affine map whose linear part is regular.
glm::dmat4x3 inverse(const glm::dmat4x3& matrix);
glm::dvec3 transform_point(const glm::dmat4x3& matrix, const glm::dvec3& point);
glm::dvec3 transform_direction(const glm::dmat4x3& matrix, const glm::dvec3& direction);

struct TriangleHit {
  double t = 0;  ///< in lengths of the direction
  double u = 0;  ///< weight of the second corner
  double v = 0;  ///< weight of the third corner
  bool front_face = false;
};

/// Where the line meets the triangle, whatever t is; nothing when it passes beside or runs in the plane.
std::optional<TriangleHit> intersect(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& origin,
                                     const glm::dvec3& direction);

}  // namespace tandem::conformance
