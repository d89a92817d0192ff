// A camera that sees everything around it: longitude and latitude.

#ifndef TANDEM_CAMERA_EQUIRECTANGULAR
#define TANDEM_CAMERA_EQUIRECTANGULAR

#include "math.glsl"

/// The unit direction of a point of the film: `forward` in its centre, `up` along its upper edge, -forward along the left
/// and the right one. The three vectors are orthonormal.
precise vec3 equirectangular_direction(vec2 film, vec3 right, vec3 up, vec3 forward) {
  vec2 longitude = det_sincos(PI * film.x);
  vec2 latitude = det_sincos(HALF_PI * film.y);
  vec3 direction = (right * (latitude.y * longitude.x) + up * latitude.x) + forward * (latitude.y * longitude.y);
  return det_normalize(direction, forward);
}

#endif
