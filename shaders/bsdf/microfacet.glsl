// Surfaces of microscopic facets with the normals of Trowbridge and Reitz (GGX), shadowed after Smith with correlated
// heights (Heitz, Understanding the Masking-Shadowing Function, JCGT 3(2), 2014). Directions are unit vectors in the
// shading frame and point away from the surface.

#ifndef TANDEM_BSDF_MICROFACET
#define TANDEM_BSDF_MICROFACET

#include "math.glsl"

// A smoother surface would be a mirror within the precision of a float's half vector; what is given as smoother, is
// this.
const float SMALLEST_ALPHA = 1e-3;

// Nothing is scattered to or from flatter directions.
const float SMALLEST_COSINE = 1e-5;

/// The width of the distribution for a perceptual roughness.
precise float ggx_alpha(float roughness) {
  precise float alpha = roughness * roughness;
  return alpha > SMALLEST_ALPHA ? (alpha < 1.0 ? alpha : 1.0) : SMALLEST_ALPHA;
}

/// The facets that send light from one direction to the other, and how many there are.
struct Facets {
  vec3 normal;     // unit, on the side of the surface's normal
  float cosine_o;  // of wo with it, positive
  float cosine_i;  // of wi with it, negative for refraction
  float shape;     // D G2 / (|cos(wo)| |cos(wi)|), 0 where there are none
  float visible;   // density of visible_normal over cosine_o
};

/// `eta`: for refraction the index on the side of wi over that on the side of wo, 1 for reflection. The cosine of wo is
/// positive, that of wi not 0.
precise Facets facets_between(float alpha, vec3 wo, vec3 wi, float eta) {
  Facets facets;
  precise vec3 normal = det_normalize(wo + wi * eta, vec3(0.0, 0.0, 1.0));
  if (normal.z < 0.0) normal = -normal;
  precise float cosine_o = det_dot(wo, normal);
  precise float cosine_i = det_dot(wi, normal);
  facets.normal = normal;
  facets.cosine_o = cosine_o;
  facets.cosine_i = cosine_i;
  facets.shape = 0.0;
  facets.visible = 0.0;
  if (!(cosine_o > 0.0 && (wi.z > 0.0 ? cosine_i > 0.0 : cosine_i < 0.0))) return facets;

  float alpha2 = alpha * alpha;
  float spread = (normal.x * normal.x + normal.y * normal.y) + alpha2 * (normal.z * normal.z);
  float distribution = det_div(alpha2 * INV_PI, spread * spread);
  float slant_o = det_sqrt(alpha2 * (wo.x * wo.x + wo.y * wo.y) + wo.z * wo.z);
  float slant_i = det_sqrt(alpha2 * (wi.x * wi.x + wi.y * wi.y) + wi.z * wi.z);
  // G2 = 2 |cos_o| |cos_i| / (|cos_o| slant_i + |cos_i| slant_o), G1 = 2 cos_o / (cos_o + slant_o).
  facets.shape = det_div(2.0 * distribution, wo.z * slant_i + abs(wi.z) * slant_o);
  facets.visible = det_div(2.0 * distribution, wo.z + slant_o);
  return facets;
}

/// A facet's normal, with the density G1 cos D / cos(wo) of those that wo sees, which is facets.visible * cosine_o
/// (Dupuy and Benyoub, Sampling Visible GGX Normals with Spherical Caps, HPG 2023). u in [0, 1)^2.
precise vec3 visible_normal(float alpha, vec3 wo, vec2 u) {
  vec3 stretched = det_normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z), vec3(0.0, 0.0, 1.0));
  float down = u.y * (1.0 + stretched.z);
  precise float radius2 = down * (2.0 - down);
  float radius = radius2 > 0.0 ? det_sqrt(radius2) : 0.0;
  vec2 turn = det_sincos(2.0 * PI * u.x);
  return det_normalize(vec3(alpha * (turn.y * radius + stretched.x), alpha * (turn.x * radius + stretched.y),
                            (1.0 - u.y) * (1.0 + stretched.z)),
                       vec3(0.0, 0.0, 1.0));
}

/// Per solid angle of the reflected direction, when a visible normal is chosen.
precise float reflection_density(Facets facets) { return 0.25 * facets.visible; }

#endif
