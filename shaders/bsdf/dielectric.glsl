// A smooth interface between two dielectrics, such as glass: reflection and refraction, one of them chosen with the
// probability that Fresnel's equations give it. Directions are unit vectors in the shading frame and point away from
// the surface; wo is above it.
//
// Radiance is not conserved by refraction, radiance / eta^2 is: light that enters a denser medium is squeezed into a
// smaller solid angle. A path from the camera therefore carries the factor (n_o / n_i)^2, where wo lies in n_o and wi
// in n_i, as in pbrt and Mitsuba for radiance transport. It cancels when the path leaves the medium again; it matters
// for lights inside.

#ifndef TANDEM_BSDF_DIELECTRIC
#define TANDEM_BSDF_DIELECTRIC

#include "bsdf/bsdf_sample.glsl"
#include "bsdf/fresnel.glsl"

/// `eta`: index of refraction beyond the surface over that on the side of wo. `transmittance` tints what is refracted.
/// u in [0, 1).
precise BsdfSample dielectric_sample(vec3 transmittance, float eta, vec3 wo, float u) {
  float transmitted_cosine = refracted_cosine(wo.z, eta);
  precise float reflectance = fresnel_dielectric(wo.z, transmitted_cosine, eta);
  if (u < reflectance) return BsdfSample(vec3(-wo.x, -wo.y, wo.z), vec3(1.0), 0.0, LOBE_SPECULAR, 1.0);
  float inverse_eta = det_div(1.0, eta);
  vec3 wi = vec3(-wo.x * inverse_eta, -wo.y * inverse_eta, -transmitted_cosine);
  return BsdfSample(wi, transmittance * (inverse_eta * inverse_eta), 0.0, LOBE_SPECULAR | LOBE_TRANSMISSION, eta);
}

#endif
