// The phase function of media.

#ifndef TANDEM_INTEGRATOR_PHASE_FUNCTION
#define TANDEM_INTEGRATOR_PHASE_FUNCTION

#include "math.glsl"

/// The phase function of Henyey and Greenstein (1941), which is also its density per solid angle. `cosine` between the
/// directions of travel before and after; `anisotropy` in (-1, 1).
precise float phase_density(float anisotropy, float cosine) {
  // 1 + g^2 - 2 g cos as a sum of what is not negative.
  float magnitude = abs(anisotropy);
  float forward = anisotropy < 0.0 ? -cosine : cosine;
  float gap = forward < 1.0 ? 1.0 - forward : 0.0;
  float squared = (1.0 - magnitude) * (1.0 - magnitude) + 2.0 * magnitude * gap;
  float quarter_inv_pi = 0.25 * INV_PI;
  return det_div(quarter_inv_pi * ((1.0 - magnitude) * (1.0 + magnitude)), squared * det_sqrt(squared));
}

/// A direction with that density in a frame whose z is the direction of travel. u in [0, 1)^2.
precise vec3 sample_phase(float anisotropy, vec2 u) {
  // The usual inverse of the distribution function, with 2 g divided out so that it holds for g = 0 too.
  float g = anisotropy;
  float k = 2.0 * u.x - 1.0;
  float square = k * k;
  float numerator = ((k + g * (0.5 * (square + 3.0))) + (g * g) * k) + (g * g * g) * (0.5 * (square - 1.0));
  float base = 1.0 + g * k;
  precise float cosine = det_div(numerator, base * base);
  cosine = cosine > -1.0 ? (cosine < 1.0 ? cosine : 1.0) : -1.0;
  float sine = det_sqrt((1.0 - cosine) * (1.0 + cosine));
  vec2 turn = det_sincos(2.0 * PI * u.y);
  return vec3(sine * turn.y, sine * turn.x, cosine);
}

#endif
