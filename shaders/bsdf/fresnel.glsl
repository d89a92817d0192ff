// Fresnel's equations: exact for dielectrics and conductors, and Schlick's approximation.

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

/// The fraction of unpolarised light that a conductor with the complex index of refraction eta + i absorption reflects
/// (Born and Wolf, Principles of Optics, section 14.2), in [0, 1].
precise float fresnel_conductor(float cosine, float eta, float absorption) {
  float c = cosine > 1e-4 ? (cosine < 1.0 ? cosine : 1.0) : 1e-4;
  float cosine2 = c * c;
  float sine2 = 1.0 - cosine2;
  float t0 = (eta * eta - absorption * absorption) - sine2;
  float modulus = det_sqrt(t0 * t0 + 4.0 * (eta * eta) * (absorption * absorption));
  precise float a2 = 0.5 * (modulus + t0);
  float twice_a_c = a2 > 0.0 ? 2.0 * det_sqrt(a2) * c : 0.0;
  float t1 = modulus + cosine2;
  float perpendicular = det_div(t1 - twice_a_c, t1 + twice_a_c);
  float t3 = cosine2 * modulus + sine2 * sine2;
  float t4 = twice_a_c * sine2;
  precise float sum = t3 + t4;
  float parallel = sum > 0.0 ? perpendicular * det_div(t3 - t4, sum) : 1.0;
  precise float reflectance = 0.5 * (perpendicular + parallel);
  return reflectance > 0.0 ? reflectance : 0.0;  // where nothing is reflected, rounding may leave less
}

/// (1 - cosine)^5, with which Schlick (1994) goes from the reflectance at normal incidence to that at grazing angles.
precise float schlick_factor(float cosine) {
  precise float m = 1.0 - cosine;
  if (!(m > 1e-5)) return 0.0;
  float m2 = m * m;
  return m2 * m2 * m;
}

#endif
