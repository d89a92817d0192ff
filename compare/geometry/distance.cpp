#include "compare/geometry/distance.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace tandem::compare {

glm::dvec3 closest_point(const Corners& triangle, const glm::dvec3& p) {
  // By the Voronoi region in which the point lies: Ericson, Real-Time Collision Detection, section 5.1.5.
  const auto& [a, b, c] = triangle;
  const auto on_segment = [&](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 along = to - from;
    const double squared_length = glm::dot(along, along);
    const double s = squared_length > 0 ? std::clamp(glm::dot(p - from, along) / squared_length, 0.0, 1.0) : 0.0;
    return from + s * along;
  };
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const auto is_inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(glm::cross(to - from, p - from), normal) >= 0;
  };
  if (glm::dot(normal, normal) > 0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a))
    return p - normal * (glm::dot(p - a, normal) / glm::dot(normal, normal));
  glm::dvec3 best = on_segment(a, b);
  for (const glm::dvec3& candidate : {on_segment(b, c), on_segment(c, a)})
    if (glm::distance(candidate, p) < glm::distance(best, p)) best = candidate;
  return best;
}

std::pair<glm::dvec3, glm::dvec3> closest_points(const GeometryRay& ray, double t_max, const glm::dvec3& from,
                                                 const glm::dvec3& to) {
  const glm::dvec3 &origin = ray.origin, &direction = ray.direction;
  const glm::dvec3 along = to - from;
  const double a = glm::dot(direction, direction), b = glm::dot(direction, along), c = glm::dot(along, along);
  const glm::dvec3 between = origin - from;
  const double determinant = a * c - b * b;
  double s = c > 0 ? glm::dot(between, along) / c : 0;  // of the ray's origin: for a ray along the segment
  if (determinant > 1e-12 * a * c) s = (a * glm::dot(between, along) - b * glm::dot(between, direction)) / determinant;
  const glm::dvec3 on_segment = from + std::clamp(s, 0.0, 1.0) * along;
  const double t = std::clamp(glm::dot(on_segment - origin, direction) / a, 0.0, t_max);
  return {origin + t * direction, on_segment};
}

double distance_from_line(const GeometryRay& ray, const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 along = glm::normalize(ray.direction);
  const auto aside = [&](const glm::dvec3& p) {
    const glm::dvec3 from_origin = p - ray.origin;
    return from_origin - glm::dot(from_origin, along) * along;
  };
  const glm::dvec3 begin = aside(from), edge = aside(to) - begin;
  const double squared_length = glm::dot(edge, edge);
  const double s = squared_length > 0 ? std::clamp(-glm::dot(begin, edge) / squared_length, 0.0, 1.0) : 0.0;
  return glm::length(begin + s * edge);
}

}  // namespace tandem::compare
