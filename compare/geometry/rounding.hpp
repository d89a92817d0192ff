#pragma once

#include <glm/vec3.hpp>

/// What single precision may do to a position.
namespace tandem::compare {

/// How many units in the last place of the largest coordinate involved a device may be off: backends transform, clip
/// and intersect in single precision, and this is what the path tracer's own offset allows them. OFFSET_ULP of
/// shaders/geometry/offset_ray.glsl is the same number (a test reads it there).
inline constexpr double tolerated_ulp = 32;

/// How far rounding may put things from where they are when the largest coordinate involved is `magnitude`.
double rounding_distance(double magnitude);

/// The largest magnitude of the three coordinates.
double largest_magnitude(const glm::dvec3& v);

}  // namespace tandem::compare
