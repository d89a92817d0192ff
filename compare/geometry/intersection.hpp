#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "pathtracer/scene/buffers.hpp"

/// Where a ray meets a primitive, in doubles, and what a device that computes in single precision may say of it.
namespace tandem::compare {

/// A ray in the space of a geometry.
struct GeometryRay {
  glm::dvec3 origin;
  glm::dvec3 direction;  ///< not 0
  double magnitude = 0;  ///< of the coordinates that its origin was computed from
};

/// How many units in the last place of the largest coordinate involved a device may be off: what the path tracer's own
/// offset allows it (shaders/geometry/offset_ray.glsl), and compare/cause/arbitration.hpp.
inline constexpr double tolerated_ulp = 32;

/// A surface on a ray, or so close to it that rounding may put it there.
struct Intersection {
  double t_low = 0;  ///< rounding leaves t within these two
  double t_high = 0;
  bool certain = false;                        ///< rounding cannot make the ray miss it
  std::optional<bool> front_face;              ///< of triangles: the facing, unless rounding leaves it open
  std::array<double, 2> barycentrics{};        ///< of triangles
  std::array<double, 2> barycentric_errors{};  ///< how far rounding may put them off
};

/// The corners of a triangle.
using Corners = std::array<glm::dvec3, 3>;

/// Nothing when the ray passes it by; t may be negative.
std::optional<Intersection> meet(const GeometryRay& ray, const Corners& corners);

/// Where the ray enters and leaves the sphere, at the time when the shutter opens; none when it passes by.
std::vector<Intersection> meet(const GeometryRay& ray, const pathtracer::GpuSphere& sphere);

}  // namespace tandem::compare
