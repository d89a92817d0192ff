// A rough metal: facets that reflect by Fresnel's equations for a measured complex index of refraction, or by Schlick's
// approximation, and a lobe for the light that is reflected more than once between them. It is sampled by the visible
// normals, and that lobe by cosine. Directions are unit vectors in the shading frame and point away from the surface.

#ifndef TANDEM_BSDF_CONDUCTOR
#define TANDEM_BSDF_CONDUCTOR

#include "bsdf/bsdf_parameters.glsl"
#include "bsdf/bsdf_sample.glsl"
#include "bsdf/microfacet.glsl"
#include "bsdf/microfacet_albedo.glsl"

precise vec3 conductor_fresnel(BsdfParameters parameters, float cosine) {
  if (max_component(parameters.eta) > 0.0) {
    return vec3(fresnel_conductor(cosine, parameters.eta.x, parameters.absorption.x),
                fresnel_conductor(cosine, parameters.eta.y, parameters.absorption.y),
                fresnel_conductor(cosine, parameters.eta.z, parameters.absorption.z));
  }
  return parameters.reflectance + (vec3(1.0) - parameters.reflectance) * schlick_factor(cosine);
}

/// With which the facets are sampled and not the lobe that compensates their loss.
precise float conductor_facet_probability(vec3 wo, float alpha) { return 1.0 - microfacet_albedo(wo.z, alpha).loss; }

/// wo and wi are above the surface.
precise BsdfValue conductor_value(BsdfParameters parameters, float alpha, Facets facets, vec3 wo, vec3 wi) {
  float loss_o = microfacet_albedo(wo.z, alpha).loss;
  float loss_i = microfacet_albedo(wi.z, alpha).loss;
  float mean_loss = mean_microfacet_albedo(alpha).loss;
  vec3 normal_reflectance = conductor_fresnel(parameters, 1.0);
  vec3 compensation =
      vec3(compensation_color(normal_reflectance.x, mean_loss), compensation_color(normal_reflectance.y, mean_loss),
           compensation_color(normal_reflectance.z, mean_loss));
  return BsdfValue(conductor_fresnel(parameters, facets.cosine_o) * (0.25 * facets.shape) +
                       compensation * compensation_value(loss_o, loss_i, mean_loss),
                   (1.0 - loss_o) * reflection_density(facets) + loss_o * (wi.z * INV_PI));
}

#endif
