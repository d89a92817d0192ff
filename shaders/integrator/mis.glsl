// Multiple importance sampling (Veach 1997, chapter 9): light from a light in some direction is estimated once by the
// sampling of lights and once by that of the BSDF, and each estimate is weighted by how likely it was to be made.

#ifndef TANDEM_INTEGRATOR_MIS
#define TANDEM_INTEGRATOR_MIS

#include "integrator/options.glsl"
#include "math.glsl"
#include "scene.glsl"

/// The weight of a direction that was sampled with `density` > 0 where the other technique has density `other`: by the
/// balance heuristic or the power heuristic with exponent 2. Both per solid angle.
precise float heuristic(float density, float other) {
  precise float ratio = det_div(other, density);
  // Also where a density is infinite, or so much larger that its square would be.
  if (!(ratio < 1e15)) return 0.0;
  return det_div(1.0, option_mis() == MIS_POWER ? 1.0 + ratio * ratio : 1.0 + ratio);
}

/// Of light that next event estimation found. `light` is the density with which it did, 0 for a light without extent,
/// which no scattered ray meets.
precise float light_sample_weight(float light, float bsdf) {
  if (!(light > 0.0) || option_mis() == MIS_NONE) return 1.0;
  return heuristic(light, bsdf);
}

/// Of a light, or the environment, that a scattered ray met. `bsdf` is the density of the ray, `light` that with which
/// next event estimation takes its direction, either of them 0 where that could not.
precise float scattered_weight(float bsdf, float light) {
  if (!(bsdf > 0.0 && light > 0.0)) return 1.0;
  if (option_mis() == MIS_NONE) return 0.0;
  return heuristic(bsdf, light);
}

#endif
