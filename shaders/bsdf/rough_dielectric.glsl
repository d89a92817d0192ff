// A rough interface between two dielectrics, such as frosted glass (Walter et al., Microfacet Models for Refraction
// through Rough Surfaces, EGSR 2007). A facet reflects or refracts with the probability of its Fresnel reflectance.
// What is reflected or refracted more than once between facets is lost. Directions are unit vectors in the shading
// frame and point away from the surface; wo is above it.
//
// As in dielectric.glsl a path from the camera carries (n_o / n_i)^2: the value for refraction contains 1 / eta^2, and
// value(wo, wi, eta) * eta^2 == value(wi, wo, 1 / eta).

#ifndef TANDEM_BSDF_ROUGH_DIELECTRIC
#define TANDEM_BSDF_ROUGH_DIELECTRIC

#include "bsdf/bsdf_sample.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/microfacet.glsl"

/// `eta`: index of refraction beyond the surface over that on the side of wo, not 1. `facets`: between wo and wi with
/// eta where wi is below the surface, with 1 where it is above.
precise BsdfValue rough_dielectric_value(vec3 transmittance, float eta, Facets facets, vec3 wi) {
  if (!(facets.visible > 0.0)) return BsdfValue(vec3(0.0), 0.0);
  float transmitted_cosine = wi.z > 0.0 ? refracted_cosine(facets.cosine_o, eta) : -facets.cosine_i;
  precise float reflectance = fresnel_dielectric(facets.cosine_o, transmitted_cosine, eta);
  if (wi.z > 0.0) return BsdfValue(vec3(reflectance * (0.25 * facets.shape)), reflectance * reflection_density(facets));
  float along = facets.cosine_o + eta * facets.cosine_i;
  float squeezed = det_div((1.0 - reflectance) * facets.cosine_o * abs(facets.cosine_i), along * along);
  return BsdfValue(transmittance * (squeezed * facets.shape), squeezed * facets.visible * (eta * eta));
}

/// The direction that a facet with the given normal sends wo to, and the lobe. u in [0, 1).
precise vec3 rough_dielectric_direction(float eta, vec3 wo, vec3 normal, float u, out uint lobe) {
  precise float cosine = det_dot(wo, normal);
  float transmitted_cosine = refracted_cosine(cosine, eta);
  precise float reflectance = fresnel_dielectric(cosine, transmitted_cosine, eta);
  if (u < reflectance) {
    lobe = LOBE_GLOSSY;
    return normal * (2.0 * cosine) - wo;
  }
  lobe = LOBE_GLOSSY | LOBE_TRANSMISSION;
  float inverse_eta = det_div(1.0, eta);
  return normal * (cosine * inverse_eta - transmitted_cosine) - wo * inverse_eta;
}

#endif
