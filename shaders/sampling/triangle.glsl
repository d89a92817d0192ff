// Points on a triangle.

#ifndef TANDEM_SAMPLING_TRIANGLE
#define TANDEM_SAMPLING_TRIANGLE

#include "math.glsl"

/// The barycentric coordinates of the second and third vertex of a uniformly distributed point; u in [0, 1)^2.
precise vec2 uniform_triangle(vec2 u) {
  float root = det_sqrt(u.x);
  return vec2(root * (1.0 - u.y), root * u.y);
}

#endif
