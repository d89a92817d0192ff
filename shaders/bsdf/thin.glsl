// A smooth sheet of a dielectric that is too thin to displace light, such as a window pane or a soap film without its
// colours: light goes straight on or is reflected, and what is reflected between its two faces is added up. Directions
// are unit vectors in the shading frame and point away from the surface; wo is above it.

#ifndef TANDEM_BSDF_THIN
#define TANDEM_BSDF_THIN

#include "bsdf/bsdf_sample.glsl"
#include "bsdf/fresnel.glsl"

/// r + t^2 (1 - r)^2 r / (1 - t^2 r^2) is reflected and t (1 - r)^2 / (1 - t^2 r^2) passes, for faces that reflect r
/// and the fraction t that one pass through the sheet leaves. Which, is chosen with the probability for t = 1. u in [0,
/// 1).
precise BsdfSample thin_sample(vec3 transmittance, float ior, vec3 wo, float u) {
  float face = fresnel_dielectric(wo.z, refracted_cosine(wo.z, ior), ior);
  precise float reflected = det_div(2.0 * face, 1.0 + face);
  precise float pass = (1.0 - face) * (1.0 - face);
  vec3 t2r2 = transmittance * transmittance * (face * face);
  vec3 series = vec3(det_div(pass, 1.0 - (t2r2.x < 0.9999 ? t2r2.x : 0.9999)),
                     det_div(pass, 1.0 - (t2r2.y < 0.9999 ? t2r2.y : 0.9999)),
                     det_div(pass, 1.0 - (t2r2.z < 0.9999 ? t2r2.z : 0.9999)));
  if (u < reflected) {
    return BsdfSample(vec3(-wo.x, -wo.y, wo.z),
                      (vec3(1.0) + transmittance * transmittance * series) * det_div(face, reflected), 0.0,
                      LOBE_SPECULAR, 1.0);
  }
  return BsdfSample(-wo, transmittance * series * det_div(1.0, 1.0 - reflected), 0.0, LOBE_SPECULAR | LOBE_TRANSMISSION,
                    1.0);
}

#endif
