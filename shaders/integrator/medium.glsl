// Homogeneous participating media: how far a ray comes, and where it goes from there. Which medium is around a point is
// known from the surfaces that a path crossed: inside of a surface it is that of the surface's material, outside that
// around everything; media do not nest. Colours differ in how far they come, so the distance is sampled for one of them,
// each with the probability 1/3, and weighted by the balance heuristic over all three: no weight exceeds 3.

#ifndef TANDEM_INTEGRATOR_MEDIUM
#define TANDEM_INTEGRATOR_MEDIUM

#include "math.glsl"
#include "random.glsl"
#include "sampling/alias_table.glsl"
#include "scene.glsl"

/// The medium beyond a surface of this material. `entering`: seen from outside.
uint medium_beyond(uint material, bool entering) { return entering ? materials[material].medium : render.medium; }

/// The fraction of light that is left of each colour (Beer and Lambert). `distance` >= 0, as far as RAY_LENGTH.
precise vec3 transmittance(vec3 extinction, float distance) {
  vec3 depth = extinction * distance;
  return vec3(det_exp(-depth.x), det_exp(-depth.y), det_exp(-depth.z));
}

precise vec3 medium_extinction(uint medium) { return media[medium].absorption + media[medium].scattering; }

/// Over `distance` within a medium, or none.
precise vec3 medium_transmittance(uint medium, float distance) {
  if (medium == NO_MEDIUM) return vec3(1.0);
  return transmittance(medium_extinction(medium), distance);
}

struct MediumSample {
  bool scattered;  // before the ray came to its end, at
  float distance;
  vec3 weight;     // transmittance, times the scattering coefficient where it scattered, over the probability (density)
};

/// How far a ray comes of the distance to the next surface.
precise MediumSample sample_medium(uint medium, float distance, uvec2 bits) {
  vec3 extinction = medium_extinction(medium);
  vec3 scattering = media[medium].scattering;
  MediumSample result;
  result.scattered = false;
  result.distance = distance;
  result.weight = vec3(1.0);
  if (!(max_component(scattering) > 0.0)) {
    result.weight = transmittance(extinction, distance);
    return result;
  }
  uint channel = uniform_index(bits.x, 3);
  precise float rate = channel == 0 ? extinction.x : channel == 1 ? extinction.y : extinction.z;
  if (rate > NEGLIGIBLE) {
    precise float free_path = det_div(-det_log(1.0 - unit_interval(bits.y)), rate);
    if (free_path < distance) {
      result.scattered = true;
      result.distance = free_path;
    }
  }
  vec3 remaining = transmittance(extinction, result.distance);
  vec3 densities = drop_negligible(result.scattered ? extinction * remaining : remaining);
  precise float density = ((densities.x + densities.y) + densities.z) * (1.0 / 3.0);
  vec3 values = drop_negligible(result.scattered ? scattering * remaining : remaining);
  result.weight = vec3(0.0);
  if (density > 0.0) {
    result.weight = vec3(det_div(values.x, density), det_div(values.y, density), det_div(values.z, density));
  }
  return result;
}

/// The phase function of Henyey and Greenstein (1941), which is also its density per solid angle. `cosine` between the
/// directions of travel before and after; `anisotropy` in (-1, 1).
precise float phase_density(float anisotropy, float cosine) {
  // 1 + g^2 - 2 g cos as a sum of what is not negative.
  float magnitude = abs(anisotropy);
  float forward = anisotropy < 0.0 ? -cosine : cosine;
  float gap = forward < 1.0 ? 1.0 - forward : 0.0;
  float squared = (1.0 - magnitude) * (1.0 - magnitude) + 2.0 * magnitude * gap;
  float quarter_inv_pi = 0.25 * INV_PI;
  return det_div(quarter_inv_pi * ((1.0 - magnitude) * (1.0 + magnitude)), squared * det_sqrt(squared));
}

/// A direction with that density in a frame whose z is the direction of travel. u in [0, 1)^2.
precise vec3 sample_phase(float anisotropy, vec2 u) {
  // The usual inverse of the distribution function, with 2 g divided out so that it holds for g = 0 too.
  float g = anisotropy;
  float k = 2.0 * u.x - 1.0;
  float square = k * k;
  float numerator = ((k + g * (0.5 * (square + 3.0))) + (g * g) * k) + (g * g * g) * (0.5 * (square - 1.0));
  float base = 1.0 + g * k;
  precise float cosine = det_div(numerator, base * base);
  cosine = cosine > -1.0 ? (cosine < 1.0 ? cosine : 1.0) : -1.0;
  float sine = det_sqrt((1.0 - cosine) * (1.0 + cosine));
  vec2 turn = det_sincos(2.0 * PI * u.y);
  return vec3(sine * turn.y, sine * turn.x, cosine);
}

#endif
