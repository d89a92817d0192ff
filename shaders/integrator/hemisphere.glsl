// An option for studies: directions all over the hemisphere in place of what a BSDF would sample.

#ifndef TANDEM_INTEGRATOR_HEMISPHERE
#define TANDEM_INTEGRATOR_HEMISPHERE

#include "bsdf/bsdf.glsl"
#include "integrator/options.glsl"
#include "sampling/hemisphere.glsl"

/// Whether the options say so, of a surface whose BSDF has a density or not.
bool samples_hemisphere(bool has_density) { return has_density && option_bsdf_sampling() != BSDF_SAMPLING_BSDF; }

/// Whether light comes through the surface by a density.
bool is_translucent(BsdfParameters parameters) {
  return FEATURE_MATERIALS && (parameters.model == MATERIAL_ROUGH_DIELECTRIC ||
                               (parameters.model == MATERIAL_PRINCIPLED && parameters.transmission > 0.0));
}

/// Solid-angle density of hemisphere_sample at wi: that of the hemisphere of wo, or half of it for each of both.
precise float hemisphere_density(BsdfParameters parameters, vec3 wi) {
  bool translucent = is_translucent(parameters);
  if (!(wi.z > 0.0 || translucent)) return 0.0;
  float density = option_bsdf_sampling() == BSDF_SAMPLING_UNIFORM ? UNIFORM_HEMISPHERE_DENSITY
                                                                  : cosine_hemisphere_density(abs(wi.z));
  return translucent ? 0.5 * density : density;
}

/// u in [0, 1)^3.
precise BsdfSample hemisphere_sample(BsdfParameters parameters, vec3 wo, vec3 u) {
  vec3 wi = option_bsdf_sampling() == BSDF_SAMPLING_UNIFORM ? uniform_hemisphere(u.xy) : cosine_hemisphere(u.xy);
  bool through = is_translucent(parameters) && u.z < 0.5;
  if (through) wi.z = -wi.z;
  BsdfSample scattered;
  scattered.direction = wi;
  scattered.weight = vec3(0.0);
  scattered.density = hemisphere_density(parameters, wi);
  bool diffuse = parameters.model == MATERIAL_DIFFUSE || parameters.model == MATERIAL_OREN_NAYAR;
  scattered.lobe = diffuse ? LOBE_DIFFUSE : LOBE_GLOSSY;
  if (through) scattered.lobe |= LOBE_TRANSMISSION;
  bool refracts = through && parameters.model == MATERIAL_ROUGH_DIELECTRIC;
  scattered.eta = refracts ? relative_index(parameters) : 1.0;
  if (scattered.density > 0.0) {
    scattered.weight = bsdf_evaluate(parameters, wo, wi) * det_div(abs(wi.z), scattered.density);
  }
  return scattered;
}

#endif
