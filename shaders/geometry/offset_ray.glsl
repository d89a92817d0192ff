// Where a ray that leaves a surface starts (or a shadow ray that ends on one, ends), so that it does not meet that
// surface again. No global epsilon: the distance is a number of float spacings (ULP) of the coordinates that the error
// comes from, so it follows the scale of the scene. The idea of counting in ULP is that of Wächter and Binder (Ray
// Tracing Gems, chapter 6, 2019); theirs counts in the ULP of each coordinate and so needs a scene of about unit size
// near zero.

#ifndef TANDEM_GEOMETRY_OFFSET_RAY
#define TANDEM_GEOMETRY_OFFSET_RAY

#include "math.glsl"

// A hit point, and a backend's own intersection test, are off the plane by a few ULP, five in the worst case that the
// tests find; the rest is margin for tests that begin with a transform of the ray.
const uint OFFSET_ULP = 32;

/// How far from the plane of a triangle its rays start. `extent`: the largest |x|, |y| and |z| of its vertices;
/// `position` a point on it; `normal` its unit geometric normal.
precise float offset_distance(vec3 position, vec3 normal, vec3 extent) {
  // Rounding moves a point along the normal by what each coordinate's rounding contributes in that direction: nothing
  // at all in the long directions of an axis-aligned plane. A plane through the origin has no such error; there the
  // spacing at the point itself, or at a thousandth of the triangle, keeps the offset from vanishing.
  precise float scale = det_dot(abs(normal), extent);
  float at_position = max_magnitude(position);
  scale = scale > at_position ? scale : at_position;
  precise float thousandth = 0.0009765625 * max_magnitude(extent);
  scale = scale > thousandth ? scale : thousandth;
  scale = scale > 1e-30 ? scale : 1e-30;
  return uintBitsToFloat(floatBitsToUint(scale) + OFFSET_ULP) - scale;
}

/// `position` moved off its surface by `distance`, to the side to which `direction` points.
precise vec3 offset_point(vec3 position, vec3 normal, float distance, vec3 direction) {
  return position + normal * (det_dot(normal, direction) < 0.0 ? -distance : distance);
}

#endif
