// The colour of a material, as denoisers and people want to see it.

#ifndef TANDEM_BSDF_ALBEDO
#define TANDEM_BSDF_ALBEDO

#include "bsdf/bsdf_parameters.glsl"
#include "bsdf/conductor.glsl"
#include "features.glsl"

/// Which part of white light from all around the surface sends back or on, about: what matters is that it changes
/// where the material does. In [0, 1] for materials that gain no energy.
precise vec3 bsdf_albedo(BsdfParameters parameters) {
  uint model = parameters.model;
  if (model == MATERIAL_MIRROR) return parameters.reflectance;
  if (model == MATERIAL_DIELECTRIC) return parameters.transmittance;
  if (!FEATURE_MATERIALS) return parameters.base_color;
  if (model == MATERIAL_CONDUCTOR) return conductor_fresnel(parameters, 1.0);
  if (model == MATERIAL_ROUGH_DIELECTRIC || model == MATERIAL_THIN) return parameters.transmittance;
  if (model == MATERIAL_PHONG || model == MATERIAL_BLINN_PHONG) return parameters.base_color + parameters.reflectance;
  return parameters.base_color;
}

#endif
