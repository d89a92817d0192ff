// Homogeneous participating media: how far a ray comes, and where it goes from there. Which medium is around a point is
// known from the surfaces that a path crossed: inside of a surface it is that of the surface's material, outside that
// around everything; media do not nest. Colours differ in how far they come, so the distance is sampled for one of them,
// chosen in proportion to the throughput, and weighted by the balance heuristic over all three: a medium then never
// raises the sum of the throughput's channels, however often the path scatters.

#ifndef TANDEM_INTEGRATOR_MEDIUM
#define TANDEM_INTEGRATOR_MEDIUM

#include "math.glsl"
#include "random.glsl"
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

/// How far a ray comes of the distance to the next surface. @param throughput of the path, not 0
precise MediumSample sample_medium(uint medium, vec3 throughput, float distance, uvec2 bits) {
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
  float inverse_sum = det_div(1.0, (throughput.x + throughput.y) + throughput.z);
  vec3 probabilities = throughput * inverse_sum;
  precise float choice = unit_interval(bits.x);
  precise float first_two = probabilities.x + probabilities.y;
  precise float rate = choice < probabilities.x ? extinction.x : choice < first_two ? extinction.y : extinction.z;
  if (rate > NEGLIGIBLE) {
    precise float free_path = det_div(-det_log(1.0 - unit_interval(bits.y)), rate);
    if (free_path < distance) {
      result.scattered = true;
      result.distance = free_path;
    }
  }
  vec3 remaining = transmittance(extinction, result.distance);
  vec3 densities = drop_negligible((result.scattered ? extinction * remaining : remaining) * probabilities);
  precise float density = (densities.x + densities.y) + densities.z;
  vec3 values = drop_negligible(result.scattered ? scattering * remaining : remaining);
  result.weight = vec3(0.0);
  if (density > 0.0) {
    result.weight = vec3(det_div(values.x, density), det_div(values.y, density), det_div(values.z, density));
  }
  return result;
}

#endif
