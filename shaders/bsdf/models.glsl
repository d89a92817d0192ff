// Dispatch by the model of a material. Directions are unit vectors in the shading frame (z = normal) and point away
// from the surface; wo is above it. A model scatters either by a density over directions or by specular lobes alone,
// which light sampling cannot find.

#ifndef TANDEM_BSDF_MODELS
#define TANDEM_BSDF_MODELS

#include "bsdf/blinn_phong.glsl"
#include "bsdf/bsdf_parameters.glsl"
#include "bsdf/conductor.glsl"
#include "bsdf/dielectric.glsl"
#include "bsdf/lambert.glsl"
#include "bsdf/mirror.glsl"
#include "bsdf/oren_nayar.glsl"
#include "bsdf/phong.glsl"
#include "bsdf/principled.glsl"
#include "bsdf/rough_dielectric.glsl"
#include "bsdf/thin.glsl"
#include "features.glsl"

// A rough dielectric whose index is no farther from 1 bends light too little to be told from a smooth one.
const float SMALLEST_INDEX_STEP = 0.01;

/// Index of refraction beyond the surface over that on the side of wo.
precise float relative_index(BsdfParameters parameters) {
  return parameters.outside ? parameters.ior : det_div(1.0, parameters.ior);
}

/// Whether light sampling can find any direction that the material scatters to.
bool bsdf_has_density(BsdfParameters parameters) {
  if (!FEATURE_MATERIALS) return parameters.model == MATERIAL_DIFFUSE;
  precise float step = abs(parameters.ior - 1.0);
  if (parameters.model == MATERIAL_ROUGH_DIELECTRIC) return step > SMALLEST_INDEX_STEP;
  return parameters.model == MATERIAL_DIFFUSE || parameters.model == MATERIAL_OREN_NAYAR ||
         parameters.model == MATERIAL_PHONG || parameters.model == MATERIAL_BLINN_PHONG ||
         parameters.model == MATERIAL_CONDUCTOR || parameters.model == MATERIAL_PRINCIPLED;
}

/// The value and the density of a model beyond Lambert's. Transmission of a rough dielectric counts as for radiance
/// that goes from wi to wo: it contains (n_o / n_i)^2.
precise BsdfValue scattering_value(BsdfParameters parameters, vec3 wo, vec3 wi) {
  BsdfValue none;
  none.value = vec3(0.0);
  none.density = 0.0;
  uint model = parameters.model;
  bool below = wi.z < 0.0;
  if (!(wo.z > SMALLEST_COSINE && abs(wi.z) > SMALLEST_COSINE)) return none;
  if (below && model != MATERIAL_ROUGH_DIELECTRIC && model != MATERIAL_PRINCIPLED) return none;
  if (model == MATERIAL_OREN_NAYAR) return oren_nayar_value(parameters.base_color, parameters.roughness, wo, wi);
  float base = parameters.glossy_only ? 0.0 : 1.0;
  if (model == MATERIAL_PHONG)
    return phong_value(parameters.base_color, base, parameters.reflectance, parameters.exponent, wo, wi);
  if (model == MATERIAL_BLINN_PHONG)
    return blinn_phong_value(parameters.base_color, base, parameters.reflectance, parameters.exponent, wo, wi);

  float alpha = ggx_alpha(parameters.roughness);
  float eta = relative_index(parameters);
  // A thin sheet transmits as if it reflected to the mirror image of wi.
  vec3 seen = below && model == MATERIAL_PRINCIPLED ? vec3(wi.x, wi.y, -wi.z) : wi;
  Facets facets = facets_between(alpha, wo, seen, seen.z < 0.0 ? eta : 1.0);
  if (model == MATERIAL_CONDUCTOR) return conductor_value(parameters, alpha, facets, wo, wi);
  if (model == MATERIAL_ROUGH_DIELECTRIC) return rough_dielectric_value(parameters.transmittance, eta, facets, wi);
  PrincipledLobes lobes = principled_lobes(parameters, alpha, wo);
  if (parameters.glossy_only) lobes.diffuse = vec3(0.0);
  return principled_value(lobes, alpha, facets, wi);
}

/// The BSDF and the solid-angle density of bsdf_sample at wi; both 0 where it has none. wi may be on either side.
precise BsdfValue bsdf_value(BsdfParameters parameters, vec3 wo, vec3 wi) {
  if (parameters.model == MATERIAL_DIFFUSE)
    return BsdfValue(lambert_evaluate(parameters.base_color, wi), lambert_density(wi));
  if (FEATURE_MATERIALS && bsdf_has_density(parameters)) return scattering_value(parameters, wo, wi);
  return BsdfValue(vec3(0.0), 0.0);
}

/// Of bsdf_value. Who needs both saves by asking for both.
precise vec3 bsdf_evaluate(BsdfParameters parameters, vec3 wo, vec3 wi) { return bsdf_value(parameters, wo, wi).value; }
precise float bsdf_density(BsdfParameters parameters, vec3 wo, vec3 wi) {
  return bsdf_value(parameters, wo, wi).density;
}

/// A direction with the density of scattering_value, and its lobe.
precise vec3 scattering_direction(BsdfParameters parameters, vec3 wo, vec3 u, out uint lobe) {
  uint model = parameters.model;
  bool phong = model == MATERIAL_PHONG;
  lobe = LOBE_DIFFUSE;
  if (phong || model == MATERIAL_BLINN_PHONG) {
    precise float probability = diffuse_probability(parameters.base_color, parameters.reflectance);
    if (u.z >= probability) {
      lobe = LOBE_GLOSSY;
      return phong ? phong_direction(parameters.exponent, wo, u.xy)
                   : blinn_phong_direction(parameters.exponent, wo, u.xy);
    }
  }
  float alpha = ggx_alpha(parameters.roughness);
  // u.z falls into the facets that reflect, those that transmit, the cosine below the surface, or that above it.
  precise float reflecting = 0.0;
  precise float facets = 0.0;
  precise float below = 0.0;
  if (model == MATERIAL_CONDUCTOR) {
    reflecting = conductor_facet_probability(wo, alpha);
    facets = reflecting;
    below = reflecting;
    lobe = LOBE_GLOSSY;
  }
  if (model == MATERIAL_PRINCIPLED) {
    PrincipledLobes lobes = principled_lobes(parameters, alpha, wo);
    reflecting = lobes.reflection_probability;
    facets = reflecting + lobes.transmission_probability;
    below = facets + lobes.diffuse_transmission_probability;
  }
  if (model == MATERIAL_ROUGH_DIELECTRIC) facets = 1.0;
  if (u.z >= facets) {
    precise vec3 wi = cosine_hemisphere(u.xy);
    if (u.z < below) {
      lobe = LOBE_GLOSSY | LOBE_TRANSMISSION;
      wi.z = -wi.z;
    }
    return wi;
  }

  vec3 normal = visible_normal(alpha, wo, u.xy);
  if (model == MATERIAL_ROUGH_DIELECTRIC)
    return rough_dielectric_direction(relative_index(parameters), wo, normal, u.z, lobe);
  precise vec3 wi = normal * (2.0 * det_dot(wo, normal)) - wo;
  lobe = LOBE_GLOSSY;
  if (u.z >= reflecting) {
    lobe = LOBE_GLOSSY | LOBE_TRANSMISSION;
    wi.z = -wi.z;
  }
  return wi;
}

/// A sample of a model beyond Lambert's. Part of what is sampled may be lost below the surface: LOBE_NONE.
precise BsdfSample scattering_sample(BsdfParameters parameters, vec3 wo, vec3 u) {
  BsdfSample scattered;
  scattered.direction = vec3(0.0, 0.0, 1.0);
  scattered.weight = vec3(0.0);
  scattered.density = 0.0;
  scattered.lobe = LOBE_NONE;
  scattered.eta = 1.0;
  if (!(wo.z > SMALLEST_COSINE)) return scattered;

  uint lobe;
  vec3 wi = det_normalize(scattering_direction(parameters, wo, u, lobe), vec3(0.0));
  bool transmits = (lobe & LOBE_TRANSMISSION) != 0;
  precise float depth = transmits ? -wi.z : wi.z;
  if (!(depth > SMALLEST_COSINE)) return scattered;
  BsdfValue found = scattering_value(parameters, wo, wi);
  precise float density = found.density;
  if (!(density > 1e-20)) return scattered;
  scattered.direction = wi;
  scattered.weight = found.value * det_div(depth, density);
  scattered.density = density;
  scattered.lobe = lobe;
  if (transmits && parameters.model == MATERIAL_ROUGH_DIELECTRIC) scattered.eta = relative_index(parameters);
  return scattered;
}

/// A scattered direction. u in [0, 1)^3: x and y choose within a lobe, z chooses the lobe.
precise BsdfSample bsdf_sample(BsdfParameters parameters, vec3 wo, vec3 u) {
  uint model = parameters.model;
  if (model == MATERIAL_DIFFUSE) return lambert_sample(parameters.base_color, u.xy);
  if (model == MATERIAL_MIRROR) return mirror_sample(parameters.reflectance, wo);
  if (FEATURE_MATERIALS) {
    if (model == MATERIAL_THIN) return thin_sample(parameters.transmittance, parameters.ior, wo, u.z);
    if (model == MATERIAL_BOUNDARY) return BsdfSample(-wo, vec3(1.0), 0.0, LOBE_SPECULAR | LOBE_TRANSMISSION, 1.0);
    if (bsdf_has_density(parameters)) return scattering_sample(parameters, wo, u);
  }
  return dielectric_sample(parameters.transmittance, relative_index(parameters), wo, u.z);
}

#endif
