// Lambertian reflection. A surface reflects albedo / pi into every direction of the upper hemisphere.
// Directions are unit vectors in the shading frame (z = normal) and point away from the surface; wo is above it.

#ifndef TANDEM_BSDF_LAMBERT
#define TANDEM_BSDF_LAMBERT

#include "bsdf/bsdf_sample.glsl"
#include "sampling/hemisphere.glsl"

precise vec3 lambert_evaluate(vec3 albedo, vec3 wi) { return wi.z > 0.0 ? albedo * INV_PI : vec3(0.0); }

/// Solid-angle density of lambert_sample at wi.
precise float lambert_density(vec3 wi) { return wi.z > 0.0 ? cosine_hemisphere_density(wi.z) : 0.0; }

/// u in [0, 1)^2. The weight is evaluate * cos / density, which is the albedo: no division, no rounding to disagree
/// about.
precise BsdfSample lambert_sample(vec3 albedo, vec2 u) {
  vec3 wi = cosine_hemisphere(u);
  return BsdfSample(wi, albedo, lambert_density(wi), LOBE_DIFFUSE, 1.0);
}

#endif
