// Where on the film a sample lies. A box filter: every point of a pixel is equally likely.

#ifndef TANDEM_CAMERA_FILM
#define TANDEM_CAMERA_FILM

#include "math.glsl"

/// Point `u` in [0, 1)^2 of a pixel, y downwards, as coordinates in [-1, 1]^2 of the whole film, y upwards.
precise vec2 film_point(uvec2 pixel, vec2 u, uvec2 resolution) {
  return vec2(2.0 * det_div(float(pixel.x) + u.x, float(resolution.x)) - 1.0,
              1.0 - 2.0 * det_div(float(pixel.y) + u.y, float(resolution.y)));
}

#endif
