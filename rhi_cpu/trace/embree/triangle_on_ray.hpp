#pragma once

#include <array>
#include <cmath>

#include "rhi_cpu/trace/embree/scene.hpp"

namespace tandem::cpu {

using Vector = std::array<double, 3>;

inline Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Vector& a) { return std::sqrt(dot(a, a)); }

/// A triangle as a ray sees it, in the space of its bottom level, in doubles.
struct TriangleOnRay {
  std::array<Vector, 3> corners;  ///< from the ray's origin
  Vector direction;
  /// Of the ray about the edge across from each corner: the weights of the corners, but for a factor.
  Vector moments;
};

/// @param hit names the instance, geometry and primitive
TriangleOnRay triangle_on_ray(const TopLevelScene& scene, const kernel::Ray& ray, const kernel::Hit& hit);

/// Sets the barycentrics to those of the ray, or of the point of the triangle that is nearest to it; leaves them where
/// the triangle has no area as the ray sees it.
void set_barycentrics(const TriangleOnRay& triangle, kernel::Hit& hit);

/// Embree reports barycentrics of (0, 0) where the moments of a triangle sum up to less than 1e-18 (its reciprocal
/// takes that for 0): of any triangle of the size of 1e-9. This sets them right, and leaves those of a ray through the
/// first corner.
inline bool has_no_barycentrics(const kernel::Hit& hit) { return hit.barycentrics[0] == 0 && hit.barycentrics[1] == 0; }
void restore_barycentrics(const TopLevelScene& scene, const kernel::Ray& ray, kernel::Hit& hit);

}  // namespace tandem::cpu
