#pragma once

#include <glm/vec3.hpp>

#include "pathtracer/render/traced_ray.hpp"

namespace tandem::compare {

/// A ray in the space of a geometry, in doubles.
struct GeometryRay {
  glm::dvec3 origin;
  glm::dvec3 direction;  ///< not 0
  double magnitude = 0;  ///< of the coordinates that its origin was computed from
};

/// A ray in world space, without its ends.
GeometryRay geometry_ray(const pathtracer::TracedRay& ray);

}  // namespace tandem::compare
