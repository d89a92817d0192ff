#include "compare/geometry/ray.hpp"

#include "compare/geometry/rounding.hpp"

namespace tandem::compare {

GeometryRay geometry_ray(const pathtracer::TracedRay& ray) {
  const glm::dvec3 origin(ray.origin);
  return {.origin = origin, .direction = glm::dvec3(ray.direction), .magnitude = largest_magnitude(origin)};
}

}  // namespace tandem::compare
