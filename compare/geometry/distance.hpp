#pragma once

#include <utility>

#include <glm/vec3.hpp>

#include "compare/geometry/primitive.hpp"
#include "compare/geometry/ray.hpp"

/// How close rays, segments and triangles come to each other, in doubles.
namespace tandem::compare {

/// The point of a triangle that is closest to `p`. A triangle without an area counts as its edges.
glm::dvec3 closest_point(const Corners& triangle, const glm::dvec3& p);

/// The points of a ray, from its origin to `t_max`, and of the segment that are closest to each other.
std::pair<glm::dvec3, glm::dvec3> closest_points(const GeometryRay& ray, double t_max, const glm::dvec3& from,
                                                 const glm::dvec3& to);

/// The distance of a segment from the line of a ray, which goes on behind its origin.
double distance_from_line(const GeometryRay& ray, const glm::dvec3& from, const glm::dvec3& to);

}  // namespace tandem::compare
