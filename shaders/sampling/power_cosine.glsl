// Directions concentrated around z: the density (n + 1) / (2 pi) * cos^n over the hemisphere.

#ifndef TANDEM_SAMPLING_POWER_COSINE
#define TANDEM_SAMPLING_POWER_COSINE

#include "math.glsl"

/// u in [0, 1)^2.
precise vec3 power_cosine(vec2 u, float exponent) {
  precise float cosine = det_pow(u.x, det_div(1.0, exponent + 1.0));
  precise float sine2 = (1.0 - cosine) * (1.0 + cosine);
  float sine = sine2 > 0.0 ? det_sqrt(sine2) : 0.0;
  vec2 turn = det_sincos(2.0 * PI * u.y);
  return vec3(turn.y * sine, turn.x * sine, cosine);
}

/// cos^n where it is not negligible.
precise float cosine_power(float cosine, float exponent) {
  precise float power = cosine > 0.0 ? det_pow(cosine < 1.0 ? cosine : 1.0, exponent) : 0.0;
  return power > 1e-20 ? power : 0.0;
}

/// Solid-angle density of power_cosine at a direction whose cosine to the power n is given.
precise float power_cosine_density(float power, float exponent) { return (exponent + 1.0) * (0.5 * INV_PI) * power; }

#endif
