// A pinhole camera.

#ifndef TANDEM_CAMERA_PINHOLE
#define TANDEM_CAMERA_PINHOLE

#include "math.glsl"

/// The unit direction through a point of the film (film_point). `right` and `up` have the lengths of the tangents of half
/// the fields of view, `forward` has length 1.
precise vec3 pinhole_direction(vec2 film, vec3 right, vec3 up, vec3 forward) {
  return det_normalize((forward + right * film.x) + up * film.y, forward);
}

#endif
