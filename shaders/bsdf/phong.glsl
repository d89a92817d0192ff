// The modified Phong model: Lambert plus a lobe cos^n around the mirror direction, normalised such that no more is
// reflected than arrives where base_color + reflectance does not exceed 1 (Lafortune and Willems, Using the Modified
// Phong Reflectance Model for Physically Based Rendering, KU Leuven, CW 197, 1994). Directions are unit vectors in the
// shading frame and point away from the surface.

#ifndef TANDEM_BSDF_PHONG
#define TANDEM_BSDF_PHONG

#include "bsdf/bsdf_sample.glsl"
#include "geometry/frame.glsl"
#include "sampling/hemisphere.glsl"
#include "sampling/power_cosine.glsl"

const float LARGEST_EXPONENT = 1e4;  // sharper lobes would lose precision

precise float lobe_exponent(float exponent) {
  return exponent > 0.0 ? (exponent < LARGEST_EXPONENT ? exponent : LARGEST_EXPONENT) : 0.0;
}

/// With which the diffuse part is sampled and not the lobe.
precise float diffuse_probability(vec3 base_color, vec3 reflectance) {
  float diffuse = max_component(base_color);
  precise float sum = diffuse + max_component(reflectance);
  return sum > 1e-10 ? det_div(diffuse, sum) : 1.0;
}

/// wo and wi are above the surface. `base`: factor on the diffuse part of the value.
precise BsdfValue phong_value(vec3 base_color, float base, vec3 reflectance, float exponent, vec3 wo, vec3 wi) {
  float n = lobe_exponent(exponent);
  float power = cosine_power((wo.z * wi.z - wo.x * wi.x) - wo.y * wi.y, n);
  float diffuse = diffuse_probability(base_color, reflectance);
  return BsdfValue(base_color * (INV_PI * base) + reflectance * ((n + 2.0) * (0.5 * INV_PI) * power),
                   diffuse * cosine_hemisphere_density(wi.z) + (1.0 - diffuse) * power_cosine_density(power, n));
}

/// A direction of the lobe; it may lie below the surface. u in [0, 1)^2.
precise vec3 phong_direction(float exponent, vec3 wo, vec2 u) {
  return to_world(make_frame(vec3(-wo.x, -wo.y, wo.z)), power_cosine(u, lobe_exponent(exponent)));
}

#endif
