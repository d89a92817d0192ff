// The BSDF of a material: dispatch by its model. Directions are unit vectors in the shading frame (z = normal) and
// point away from the surface; wo is above it. A model scatters either by a density over directions or by specular
// lobes alone, which light sampling cannot find.

#ifndef TANDEM_BSDF_BSDF
#define TANDEM_BSDF_BSDF

#include "bsdf/dielectric.glsl"
#include "bsdf/lambert.glsl"
#include "bsdf/mirror.glsl"
#include "bsdf/parameters.glsl"

/// Whether light sampling can find any direction that the material scatters to.
bool bsdf_has_density(BsdfParameters parameters) { return parameters.model == MATERIAL_DIFFUSE; }

/// The BSDF, 0 where it has no density.
precise vec3 bsdf_evaluate(BsdfParameters parameters, vec3 wo, vec3 wi) {
  if (parameters.model != MATERIAL_DIFFUSE) return vec3(0.0);
  return lambert_evaluate(parameters.base_color, wi);
}

/// Solid-angle density of bsdf_sample at wi, 0 where it has none.
precise float bsdf_density(BsdfParameters parameters, vec3 wo, vec3 wi) {
  if (parameters.model != MATERIAL_DIFFUSE) return 0.0;
  return lambert_density(wi);
}

/// A scattered direction. u in [0, 1)^3: x and y choose within a lobe, z chooses the lobe.
precise BsdfSample bsdf_sample(BsdfParameters parameters, vec3 wo, vec3 u) {
  if (parameters.model == MATERIAL_MIRROR) return mirror_sample(parameters.reflectance, wo);
  if (parameters.model == MATERIAL_DIELECTRIC) {
    float eta = parameters.outside ? parameters.ior : det_div(1.0, parameters.ior);
    return dielectric_sample(parameters.transmittance, eta, wo, u.z);
  }
  return lambert_sample(parameters.base_color, u.xy);
}

#endif
