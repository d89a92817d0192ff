#pragma once

#include <array>
#include <optional>
#include <vector>

#include "compare/geometry/primitive.hpp"
#include "compare/geometry/ray.hpp"
#include "pathtracer/scene/buffers.hpp"

/// Where a ray meets a primitive, in doubles, and what a device that computes in single precision may say of it.
namespace tandem::compare {

/// A surface on a ray, or so close to it that rounding may put it there.
struct Intersection {
  double t_low = 0;  ///< rounding leaves t within these two
  double t_high = 0;
  bool certain = false;                        ///< rounding cannot make the ray miss it
  std::optional<bool> front_face;              ///< of triangles: the facing, unless rounding leaves it open
  std::array<double, 2> barycentrics{};        ///< of triangles
  std::array<double, 2> barycentric_errors{};  ///< how far rounding may put them off
};

/// Nothing when the ray passes it by; t may be negative.
std::optional<Intersection> meet(const GeometryRay& ray, const Corners& corners);

/// Where the ray enters and leaves the sphere, at the time when the shutter opens; none when it passes by.
std::vector<Intersection> meet(const GeometryRay& ray, const pathtracer::GpuSphere& sphere);

}  // namespace tandem::compare
