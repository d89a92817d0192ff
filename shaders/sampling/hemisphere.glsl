// Directions over the hemisphere around z.

#ifndef TANDEM_SAMPLING_HEMISPHERE
#define TANDEM_SAMPLING_HEMISPHERE

#include "math.glsl"

/// A uniform point of the unit disk in x and y, and in z its radius, up to the sign. u in [0, 1)^2 goes to the disk by
/// concentric squares (Shirley and Chiu 1997), which keep neighbours together and need sines of at most pi / 4 only.
precise vec3 concentric_disk(vec2 u) {
  precise float a = 2.0 * u.x - 1.0;
  precise float b = 2.0 * u.y - 1.0;
  bool wide = abs(a) > abs(b);
  float radius = wide ? a : b;
  if (radius == 0.0) return vec3(0.0);
  float angle = QUARTER_PI * det_div(wide ? b : a, radius);
  float along = radius * cos_kernel(angle);
  float across = radius * sin_kernel(angle);
  return vec3(wide ? along : across, wide ? across : along, radius);
}

/// The hemisphere over the unit disk, sampled with density cos / pi (Malley's method). u in [0, 1)^2.
precise vec3 cosine_hemisphere(vec2 u) {
  vec3 disk = concentric_disk(u);
  return vec3(disk.x, disk.y, det_sqrt((1.0 - disk.z) * (1.0 + disk.z)));
}

/// Solid-angle density of cosine_hemisphere at a direction with that cosine.
precise float cosine_hemisphere_density(float cosine) { return cosine * INV_PI; }

/// A uniform direction of the hemisphere: the disk raised so that areas are kept. u in [0, 1)^2.
precise vec3 uniform_hemisphere(vec2 u) {
  vec3 disk = concentric_disk(u);
  float squared_radius = disk.z * disk.z;
  float scale = det_sqrt(2.0 - squared_radius);
  return vec3(disk.x * scale, disk.y * scale, 1.0 - squared_radius);
}

/// Solid-angle density of uniform_hemisphere.
const float UNIFORM_HEMISPHERE_DENSITY = 0.159154943;

#endif
