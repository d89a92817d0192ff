// A camera with a thin lens: what is not at the distance of focus is blurred.

#ifndef TANDEM_CAMERA_THIN_LENS
#define TANDEM_CAMERA_THIN_LENS

#include "math.glsl"
#include "sampling/hemisphere.glsl"

/// A uniform point of the lens, seen from its centre; u in [0, 1)^2. `right` and `up` of any length but 0.
precise vec3 lens_point(vec2 u, float lens_radius, vec3 right, vec3 up) {
  vec2 disk = concentric_disk(u).xy * lens_radius;
  return det_normalize(right, vec3(1.0, 0.0, 0.0)) * disk.x + det_normalize(up, vec3(0.0, 1.0, 0.0)) * disk.y;
}

/// The unit direction from a point of the lens to what a pinhole in its centre would see through this point of the film at
/// the distance of focus, which is counted along `forward`. The vectors as for pinhole_direction.
precise vec3 lens_direction(vec2 film, vec3 from, float focus_distance, vec3 right, vec3 up, vec3 forward) {
  return det_normalize(((forward + right * film.x) + up * film.y) * focus_distance - from, forward);
}

#endif
