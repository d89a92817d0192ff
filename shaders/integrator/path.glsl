// The integrator: unidirectional path tracing with next event estimation at every vertex that scatters by a density,
// weighted against the lights that scattered rays run into (multiple importance sampling), and Russian roulette.
// options.glsl says what of this can be changed.

#ifndef TANDEM_INTEGRATOR_PATH
#define TANDEM_INTEGRATOR_PATH

#include "integrator/boundary.glsl"
#include "integrator/direct_light.glsl"
#include "integrator/events.glsl"
#include "integrator/mis.glsl"
#include "integrator/options.glsl"
#include "integrator/path_state.glsl"
#include "integrator/roulette.glsl"
#include "integrator/vertex.glsl"
#include "light/light.glsl"
#include "sampling/sampler.glsl"

/// Radiance of a surface that a ray meets, weighted against next event estimation.
/// @param previous the vertex that scattered the ray
precise vec3 weighted_emission(Surface surface, uint primitive, PreviousVertex previous, vec3 direction, float time) {
  vec3 radiance = emitted_radiance(surface.material, surface.texture_coordinates, surface.position);
  if (max_component(radiance) == 0.0 || previous.density == 0.0) return radiance;
  float density =
      light_density(primitive, previous.position, direction, surface.position, surface.geometric_normal, time);
  return radiance * scattered_weight(previous.density, density);
}

/// Radiance from beyond the scene, likewise.
precise vec3 weighted_environment(PreviousVertex previous, vec3 direction) {
  vec3 radiance = environment_radiance(direction);
  if (!FEATURE_LIGHTS || previous.density == 0.0) return radiance;
  return radiance * scattered_weight(previous.density, environment_density(direction));
}

/// The light that a ray runs into: that of a surface, or with NO_PRIMITIVE from beyond the scene.
precise vec3 arriving_light(Surface surface, uint primitive, PreviousVertex previous, vec3 direction, float time) {
  if (primitive == NO_PRIMITIVE) return weighted_environment(previous, direction);
  return weighted_emission(surface, primitive, previous, direction, time);
}

/// Where a ray scatters within a medium: a vertex of which only the direction of travel is known.
precise Surface point_in_medium(vec3 position, vec3 direction) {
  Surface point;
  point.position = position;
  point.geometric_normal = direction;
  point.shading_normal = direction;
  point.offset = 0.0;
  point.outside = false;
  point.material = 0;
  point.texture_coordinates = vec2(0.0);
  return point;
}

/// Traces the path's next segment and scatters at its end: CONTINUES, or END_*.
uint path_segment(inout precise PathState state) {
  state.ray_count += 1;
  precise Vertex vertex;
  vertex.in_medium = false;
  vertex.primitive =
      trace_closest(state.origin, state.direction, state.ray_length, state.key, segment_dimension(state.segment));
  if (vertex.primitive != NO_PRIMITIVE) {
    vertex.surface = surface_at(vertex.primitive, state.origin, state.direction, state.time);
    record_surface(vertex.surface);
  }
  if (FEATURE_MEDIA && state.medium != NO_MEDIUM) {
    precise float distance = RAY_LENGTH;
    if (vertex.primitive != NO_PRIMITIVE) distance = det_length(vertex.surface.position - state.origin);
    uvec2 bits = sampler_bits(state.key, medium_dimension(state.segment)).xy;
    precise MediumSample reached = sample_medium(state.medium, state.throughput, distance, bits);
    record_medium(bits, reached);
    state.throughput = drop_negligible(state.throughput * reached.weight);
    if (max_component(state.throughput) == 0.0) return END_ABSORBED;
    if (reached.scattered) {
      vertex.in_medium = true;
      vertex.primitive = NO_PRIMITIVE;
      vertex.surface = point_in_medium(state.origin + state.direction * reached.distance, state.direction);
      vertex.anisotropy = media[state.medium].anisotropy;
      vertex.has_density = true;
    }
  }
  if (!vertex.in_medium) {
    if (vertex.primitive != NO_PRIMITIVE && is_boundary(vertex.surface.material))
      return cross_boundary(state, vertex.surface);
    precise vec3 emission =
        arriving_light(vertex.surface, vertex.primitive, state.previous, state.direction, state.time);
    precise vec3 contribution = clamped(state.throughput * emission, state.depth + 1);
    state.radiance += contribution;
    record_emission(vertex.primitive == NO_PRIMITIVE, emission, contribution);
    if (vertex.primitive == NO_PRIMITIVE) return END_ESCAPED;
  }
  if (state.depth + 1 >= render.max_depth || exceeds_depths(state.scattering_count)) return END_DEPTH;

  vertex.frame = make_frame(vertex.surface.shading_normal);
  vertex.wo = to_local(vertex.frame, -state.direction);
  if (!vertex.in_medium) {
    vertex.parameters = bsdf_parameters(vertex.surface.material, vertex.surface.outside,
                                        vertex.surface.texture_coordinates, vertex.surface.position);
    vertex.has_density = bsdf_has_density(vertex.parameters);
  }
  bool estimates_lights = vertex.has_density && samples_lights();
  if (estimates_lights) {
    precise vec3 light =
        direct_light(vertex, state.medium, state.time, state.key, state.segment, state.ray_count);
    precise vec3 contribution = clamped(state.throughput * light, state.depth + 2);
    state.radiance += contribution;
    record_direct_light(contribution);
  }

  uvec4 bits = sampler_bits(state.key, scattering_dimension(state.segment));
  vec3 u = vec3(unit_interval(bits.x), unit_interval(bits.y), unit_interval(bits.z));
  precise BsdfSample scattered;
  precise vec3 direction;
  bool leaves = false;
  for (uint attempt = 0; attempt < 2 && !leaves; ++attempt) {
    scattered = vertex_sample(vertex, u);
    direction = to_world(vertex.frame, scattered.direction);
    leaves = vertex.in_medium || on_its_side(vertex.surface, scattered, direction);
    // A density just loses this part of its lobe; a specular lobe would lose all, so there the geometric normal
    // decides.
    if (vertex.has_density) break;
    vertex.frame = make_frame(vertex.surface.geometric_normal);
    vertex.wo = to_local(vertex.frame, -state.direction);
  }
  record_scatter(bits, vertex, scattered, leaves, direction);
  if (!leaves) return END_SIDE;
  state.throughput = drop_negligible(state.throughput * scattered.weight);
  if (max_component(state.throughput) == 0.0) return END_ABSORBED;
  state.eta_scale *= scattered.eta * scattered.eta;
  if (!survives_roulette(state.throughput, state.eta_scale, state.depth, bits.w)) return END_ROULETTE;
  state.medium = medium_after(vertex, state.medium, (scattered.lobe & LOBE_TRANSMISSION) != 0);
  count_scattering(state.scattering_count, scattered.lobe);
  state.previous.position = vertex.surface.position;
  state.previous.density = estimates_lights ? scattered.density : 0.0;
  state.origin =
      offset_point(vertex.surface.position, vertex.surface.geometric_normal, vertex.surface.offset, direction);
  state.direction = direction;
  state.segment += 1;
  state.depth += 1;
  return CONTINUES;
}

#endif
