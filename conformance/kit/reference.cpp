#include "conformance/kit/reference.hpp"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace tandem::conformance {

glm::dmat4x3 matrix_of(const Transform& transform) {
  glm::dmat4x3 matrix;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      matrix[column][row] = transform[static_cast<std::size_t>(row * 4 + column)];
  return matrix;
}

Transform transform_of(const glm::dmat4x3& matrix) {
  Transform transform;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      transform[static_cast<std::size_t>(row * 4 + column)] = static_cast<float>(matrix[column][row]);
  return transform;
}

glm::dmat4x3 inverse(const glm::dmat4x3& matrix) {
  const glm::dmat3 linear = glm::inverse(glm::dmat3(matrix[0], matrix[1], matrix[2]));
  return glm::dmat4x3(linear[0], linear[1], linear[2], -(linear * matrix[3]));
}

glm::dvec3 transform_point(const glm::dmat4x3& matrix, const glm::dvec3& point) {
  return transform_direction(matrix, point) + matrix[3];
}

glm::dvec3 transform_direction(const glm::dmat4x3& matrix, const glm::dvec3& direction) {
  return matrix[0] * direction.x + matrix[1] * direction.y + matrix[2] * direction.z;
}

std::optional<TriangleHit> intersect(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& origin,
                                     const glm::dvec3& direction) {
  // origin + t direction = corner 0 + u edge 1 + v edge 2, solved with determinants (Cramer's rule).
  const glm::dvec3 edge_1 = corners[1] - corners[0];
  const glm::dvec3 edge_2 = corners[2] - corners[0];
  const glm::dvec3 normal = glm::cross(edge_1, edge_2);
  const double determinant = -glm::dot(normal, direction);
  if (determinant == 0) return std::nullopt;
  const glm::dvec3 from_corner = origin - corners[0];
  const glm::dvec3 moment = glm::cross(from_corner, direction);
  const TriangleHit hit = {.t = glm::dot(normal, from_corner) / determinant,
                           .u = glm::dot(edge_2, moment) / determinant,
                           .v = -glm::dot(edge_1, moment) / determinant,
                           .front_face = determinant > 0};
  if (hit.u < 0 || hit.v < 0 || hit.u + hit.v > 1) return std::nullopt;
  return hit;
}

}  // namespace tandem::conformance
