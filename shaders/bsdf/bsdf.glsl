// The BSDF of a material: dispatch by its model. Directions are unit vectors in the shading frame (z = normal) and
// point away from the surface; wo is above it.

#ifndef TANDEM_BSDF_BSDF
#define TANDEM_BSDF_BSDF

#include "bsdf/dielectric.glsl"
#include "bsdf/lambert.glsl"
#include "bsdf/mirror.glsl"
#include "scene.glsl"

/// Whether light sampling can find any direction that the material scatters to.
bool bsdf_has_density(uint material) { return materials[material].model == MATERIAL_DIFFUSE; }

/// The BSDF without its specular lobes.
precise vec3 bsdf_evaluate(uint material, vec3 wo, vec3 wi) {
  if (materials[material].model != MATERIAL_DIFFUSE) return vec3(0.0);
  return lambert_evaluate(materials[material].base_color, wi);
}

/// Solid-angle density of bsdf_sample at wi, without its specular lobes.
precise float bsdf_density(uint material, vec3 wo, vec3 wi) {
  if (materials[material].model != MATERIAL_DIFFUSE) return 0.0;
  return lambert_density(wi);
}

/// A scattered direction. `outside`: wo is on the side of the geometric normal, outside of a dielectric. u in [0, 1)^3.
precise BsdfSample bsdf_sample(uint material, bool outside, vec3 wo, vec3 u) {
  uint model = materials[material].model;
  if (model == MATERIAL_MIRROR) return mirror_sample(materials[material].reflectance, wo);
  if (model == MATERIAL_DIELECTRIC) {
    float ior = materials[material].ior;
    float eta = outside ? ior : det_div(1.0, ior);
    return dielectric_sample(materials[material].transmittance, eta, wo, u.z);
  }
  return lambert_sample(materials[material].base_color, u.xy);
}

#endif
