// Diffuse reflection by V-shaped grooves of Lambertian facets: the qualitative model of Oren and Nayar, Generalization
// of Lambert's Reflectance Model, SIGGRAPH 1994. It leaves out light that is reflected between facets, and the rougher
// the surface the darker it is. Where it would give back more than arrives (up to 1.5 % at grazing angles, for sigma
// around 0.2) it is scaled down to what arrives. Directions are unit vectors in the shading frame and point away from
// the surface.

#ifndef TANDEM_BSDF_OREN_NAYAR
#define TANDEM_BSDF_OREN_NAYAR

#include "bsdf/bsdf_sample.glsl"
#include "sampling/hemisphere.glsl"

/// Sampled by cosine_hemisphere. `sigma`: standard deviation of the facets' slope angle, radians. wo and wi are above
/// the surface.
precise BsdfValue oren_nayar_value(vec3 albedo, float sigma, vec3 wo, vec3 wi) {
  float variance = sigma * sigma;
  float a = 1.0 - 0.5 * det_div(variance, variance + 0.33);
  float b = 0.45 * det_div(variance, variance + 0.09);
  precise float most = a + 0.5 * b;  // of a white surface at grazing angles
  float scale = most > 1.0 ? det_div(INV_PI, most) : INV_PI;
  // cos(azimuth difference) * sin(larger angle) * tan(smaller angle).
  precise float projected = wo.x * wi.x + wo.y * wi.y;
  float slope = projected > 0.0 ? det_div(projected, wo.z > wi.z ? wo.z : wi.z) : 0.0;
  return BsdfValue(albedo * (scale * (a + b * slope)), cosine_hemisphere_density(wi.z));
}

#endif
