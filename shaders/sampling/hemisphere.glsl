// Directions over the hemisphere around z.

#ifndef TANDEM_SAMPLING_HEMISPHERE
#define TANDEM_SAMPLING_HEMISPHERE

#include "math.glsl"

/// The hemisphere over the unit disk, sampled with density cos / pi (Malley's method). u in [0, 1)^2 goes to the disk
/// by concentric squares (Shirley and Chiu 1997), which keep neighbours together and need sines of at most pi / 4 only.
precise vec3 cosine_hemisphere(vec2 u) {
  precise float a = 2.0 * u.x - 1.0;
  precise float b = 2.0 * u.y - 1.0;
  bool wide = abs(a) > abs(b);
  float radius = wide ? a : b;
  if (radius == 0.0) return vec3(0.0, 0.0, 1.0);
  float angle = QUARTER_PI * det_div(wide ? b : a, radius);
  float along = radius * cos_kernel(angle);
  float across = radius * sin_kernel(angle);
  return vec3(wide ? along : across, wide ? across : along, det_sqrt((1.0 - radius) * (1.0 + radius)));
}

/// Solid-angle density of cosine_hemisphere at a direction with that cosine.
precise float cosine_hemisphere_density(float cosine) { return cosine * INV_PI; }

#endif
