// Next event estimation: radiance that arrives at a vertex directly from a sampled light.

#ifndef TANDEM_INTEGRATOR_DIRECT_LIGHT
#define TANDEM_INTEGRATOR_DIRECT_LIGHT

#include "integrator/events.glsl"
#include "integrator/mis.glsl"
#include "integrator/vertex.glsl"
#include "integrator/visibility.glsl"
#include "light/light.glsl"
#include "sampling/sampler.glsl"

/// Radiance that a light, chosen at random, sends by way of the vertex to wo, over the density of the choice and
/// weighted against the sampling of the BSDF. `medium`: around the vertex. `segment`: the one that ends there.
precise vec3 direct_light(Vertex vertex, uint medium, float time, RandomKey key, uint segment, inout uint ray_count) {
  Surface surface = vertex.surface;
  LightSample light = sample_light(surface.departure, sampler_bits(key, light_dimension(segment)), time);
  TANDEM_RECORD(event_light_sample(sampler_bits(key, light_dimension(segment)), light.primitive, light.infinite,
                                   light.direction, light.radiance, light.density, light.target);)
  if (light.primitive != NO_PRIMITIVE && light.primitive == vertex.primitive) return vec3(0.0);
  if (max_component(light.radiance) == 0.0) return vec3(0.0);
  // An interpolated normal may see it from the other side than the true surface.
  bool seen = on_its_side(surface, light.direction, to_local(vertex.frame, light.direction).z);
  if (!seen && !has_folded(vertex, light.direction)) return vec3(0.0);
  precise BsdfValue found = value_towards(vertex, light.direction);
  precise vec3 value = drop_negligible(found.value);
  if (max_component(value) == 0.0) return vec3(0.0);
  precise float weight = light_sample_weight(light.density, found.density);
  if (light.density > 0.0) weight = det_div(weight, light.density);
  TANDEM_RECORD(event_light_value(value, found.density, weight);)
  if (!(weight > 0.0 && weight < 1e30)) return vec3(0.0);

  precise vec3 from = offset_point(surface.departure, surface.geometric_normal, surface.offset, light.direction);
  precise vec3 direction = light.direction;
  if (!light.infinite) {
    direction = offset_point(light.target, light.target_normal, light.target_offset, -light.direction) - from;
    if (direction == vec3(0.0)) return vec3(0.0);
  }
  precise float side = det_dot(light.direction, surface.side_normal);
  bool transmits = side < 0.0;
  precise vec3 visible = visibility(from, direction, light.infinite ? RAY_LENGTH : 1.0,
                                    medium_after(vertex, medium, transmits), time, key, shadow_dimension(segment),
                                    ray_count);
  TANDEM_RECORD(event_visibility(visible);)
  if (max_component(visible) == 0.0) return vec3(0.0);
  return value * light.radiance * visible * weight;
}

#endif
