// The exact Fresnel equations of an interface between two dielectrics.

#ifndef TANDEM_BSDF_FRESNEL
#define TANDEM_BSDF_FRESNEL

#include "math.glsl"

/// The cosine of the refracted angle, 0 under total internal reflection. `eta`: index of refraction beyond the
/// interface over that on the side of incidence.
precise float refracted_cosine(float incident_cosine, float eta) {
  // cos^2 = (eta^2 - 1 + cos_i^2) / eta^2, written so that nothing cancels for eta = 1 at grazing angles.
  precise float scaled = (eta - 1.0) * (eta + 1.0) + incident_cosine * incident_cosine;
  return scaled > 0.0 ? det_div(det_sqrt(scaled), eta) : 0.0;
}

/// The fraction of unpolarised light that is reflected, in [0, 1]; cosines are not negative.
precise float fresnel_dielectric(float incident_cosine, float transmitted_cosine, float eta) {
  if (!(incident_cosine > 0.0 && transmitted_cosine > 0.0)) return 1.0;
  precise float eta_i = eta * incident_cosine;
  precise float eta_t = eta * transmitted_cosine;
  float parallel = det_div(eta_i - transmitted_cosine, eta_i + transmitted_cosine);
  float perpendicular = det_div(incident_cosine - eta_t, incident_cosine + eta_t);
  return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

#endif
