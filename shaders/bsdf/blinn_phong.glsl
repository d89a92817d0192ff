// Blinn and Phong's model: Lambert plus a lobe cos^n of the angle between the half vector and the normal, normalised
// such that at normal incidence the lobe reflects exactly the fraction `reflectance`, and less at other angles. The
// integral behind the factor: with wo = z, cos(half angle)^n * cos(wi) over the hemisphere is
// 8 pi (2^(-n / 2) + n) / ((n + 2) (n + 4)). Directions are unit vectors in the shading frame and point away from the
// surface.

#ifndef TANDEM_BSDF_BLINN_PHONG
#define TANDEM_BSDF_BLINN_PHONG

#include "bsdf/phong.glsl"

/// wo and wi are above the surface. `base`: factor on the diffuse part of the value.
precise BsdfValue blinn_phong_value(vec3 base_color, float base, vec3 reflectance, float exponent, vec3 wo, vec3 wi) {
  float n = lobe_exponent(exponent);
  vec3 half_vector = det_normalize(wo + wi, vec3(0.0, 0.0, 1.0));
  float power = cosine_power(half_vector.z, n);
  float factor = det_div((n + 2.0) * (n + 4.0), (8.0 * PI) * (det_exp((-0.5 * LN2) * n) + n));
  precise float along = det_dot(wo, half_vector);
  float lobe_density = along > 1e-6 ? det_div(power_cosine_density(power, n), 4.0 * along) : 0.0;
  float diffuse = diffuse_probability(base_color, reflectance);
  return BsdfValue(base_color * (INV_PI * base) + reflectance * (factor * power),
                   diffuse * cosine_hemisphere_density(wi.z) + (1.0 - diffuse) * lobe_density);
}

/// A direction of the lobe; it may lie below the surface. u in [0, 1)^2.
precise vec3 blinn_phong_direction(float exponent, vec3 wo, vec2 u) {
  return det_reflect(-wo, power_cosine(u, lobe_exponent(exponent)));
}

#endif
