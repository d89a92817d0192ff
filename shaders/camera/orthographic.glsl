// A camera whose rays are parallel.

#ifndef TANDEM_CAMERA_ORTHOGRAPHIC
#define TANDEM_CAMERA_ORTHOGRAPHIC

/// Where the ray of a point of the film starts, seen from the camera. `right` and `up` are half the width and half the
/// height of what the camera sees.
precise vec3 orthographic_point(vec2 film, vec3 right, vec3 up) { return right * film.x + up * film.y; }

#endif
