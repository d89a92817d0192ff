#include "compare/geometry/intersection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "compare/geometry/rounding.hpp"

namespace tandem::compare {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

double distance_to_segment(const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dvec2 along = to - from;
  const double squared = glm::dot(along, along);
  const double s = squared > 0 ? std::clamp(-glm::dot(from, along) / squared, 0.0, 1.0) : 0.0;
  return glm::length(from + s * along);
}

/// A triangle seen along a ray, which is the origin.
struct Projection {
  bool inside = false;    ///< the ray goes through it
  double to_outline = 0;  ///< from the ray to its nearest edge
  double height = 0;      ///< the smallest
};

Projection project(const GeometryRay& ray, const Corners& corners) {
  const glm::dvec3 along = glm::normalize(ray.direction);
  const glm::dvec3 axis = std::abs(along.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(along, axis)), up = glm::cross(right, along);
  std::array<glm::dvec2, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 from_ray = corners[i] - ray.origin;
    p[i] = {glm::dot(from_ray, right), glm::dot(from_ray, up)};
  }
  Projection seen{.inside = true, .to_outline = std::numeric_limits<double>::infinity(), .height = 0};
  const double area = cross(p[1] - p[0], p[2] - p[0]);
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec2 &from = p[i], &to = p[(i + 1) % 3];
    seen.inside = seen.inside && cross(from, to) * area > 0;
    seen.to_outline = std::min(seen.to_outline, distance_to_segment(from, to));
    longest = std::max(longest, glm::distance(from, to));
  }
  seen.height = longest > 0 ? std::abs(area) / longest : 0;
  return seen;
}

}  // namespace

std::optional<Intersection> meet(const GeometryRay& ray, const Corners& corners) {
  double magnitude = ray.magnitude;
  for (const glm::dvec3& corner : corners) magnitude = std::max(magnitude, largest_magnitude(corner));
  const double error = rounding_distance(magnitude);
  const Projection seen = project(ray, corners);
  if (!seen.inside && !(seen.to_outline <= error)) return std::nullopt;

  Intersection intersection;
  // Seen edge-on within rounding, it may be met anywhere: single precision cannot tell its plane from the ray.
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(seen.height > 2 * error)) {
    intersection.t_low = -infinity;
    intersection.t_high = infinity;
    intersection.barycentric_errors = {infinity, infinity};
    return intersection;
  }
  intersection.certain = seen.inside && seen.to_outline > error;
  const glm::dvec3 edge_1 = corners[1] - corners[0], edge_2 = corners[2] - corners[0];
  const glm::dvec3 normal = glm::cross(edge_1, edge_2), moment = glm::cross(ray.origin - corners[0], ray.direction);
  const double cosine = glm::dot(normal, ray.direction), length = glm::length(ray.direction);
  intersection.front_face = cosine < 0;
  const double slope = glm::length(normal) * length / std::abs(cosine);  // 1 / cosine of the angle of incidence
  const double in_plane = error * (1 + slope);
  const double t = glm::dot(normal, corners[0] - ray.origin) / cosine;
  intersection.t_low = t - in_plane / length;
  intersection.t_high = t + in_plane / length;
  intersection.barycentrics = {-glm::dot(edge_2, moment) / cosine, glm::dot(edge_1, moment) / cosine};
  const auto relative_to_height = [&](const glm::dvec3& base) {
    return in_plane * glm::length(base) / glm::length(normal);
  };
  intersection.barycentric_errors = {relative_to_height(edge_2), relative_to_height(edge_1)};
  return intersection;
}

std::vector<Intersection> meet(const GeometryRay& ray, const pathtracer::GpuSphere& sphere) {
  const glm::dvec3 centre(sphere.centre), from_centre = ray.origin - centre;
  const double radius = sphere.radius, length = glm::length(ray.direction);
  const double error = rounding_distance(std::max({ray.magnitude, largest_magnitude(centre), radius}));
  const double t_middle = -glm::dot(from_centre, ray.direction) / (length * length);
  const double distance = glm::length(from_centre + t_middle * ray.direction);
  if (!(distance <= radius + error)) return {};
  const auto half_chord = [&](double at_distance) {
    return std::sqrt(std::max(0.0, radius * radius - at_distance * at_distance)) / length;
  };
  const double least = half_chord(distance + error), greatest = half_chord(std::max(0.0, distance - error));
  Intersection enter, leave;
  enter.certain = leave.certain = distance < radius - error;
  enter.t_low = t_middle - greatest - error / length;
  enter.t_high = t_middle - least + error / length;
  leave.t_low = t_middle + least - error / length;
  leave.t_high = t_middle + greatest + error / length;
  return {enter, leave};
}

}  // namespace tandem::compare
