// A pinhole camera with a box filter: every point of a pixel is equally likely.

#ifndef TANDEM_CAMERA_PINHOLE
#define TANDEM_CAMERA_PINHOLE

#include "math.glsl"

/// The unit direction through point `u` in [0, 1)^2 of a pixel, y downwards. `right` and `up` have the lengths of the
/// tangents of half the fields of view, `forward` has length 1.
precise vec3 pinhole_direction(uvec2 pixel, vec2 u, uvec2 resolution, vec3 right, vec3 up, vec3 forward) {
  float x = 2.0 * det_div(float(pixel.x) + u.x, float(resolution.x)) - 1.0;
  float y = 1.0 - 2.0 * det_div(float(pixel.y) + u.y, float(resolution.y));
  return det_normalize((forward + right * x) + up * y, forward);
}

#endif
