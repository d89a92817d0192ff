// Ambient occlusion: the fraction of cosine-weighted directions in which nothing is near, which is what a white diffuse
// surface under a white sky shows. Boundaries of media hide nothing, and media themselves do not count.

#ifndef TANDEM_INTEGRATOR_AMBIENT_OCCLUSION
#define TANDEM_INTEGRATOR_AMBIENT_OCCLUSION

#include "integrator/boundary.glsl"
#include "integrator/events.glsl"
#include "integrator/path_state.glsl"
#include "integrator/vertex.glsl"
#include "sampling/sampler.glsl"
#include "trace.glsl"

/// Traces the next segment: the camera's ray, or the one of limited length from what that met. CONTINUES, or END_*.
uint ambient_occlusion_segment(inout precise PathState state) {
  state.ray_count += 1;
  precise Vertex vertex;
  vertex.in_medium = false;
  vertex.primitive =
      trace_closest(state.origin, state.direction, state.ray_length, state.key, segment_dimension(state.segment));
  if (vertex.primitive == NO_PRIMITIVE) {
    state.radiance = state.throughput;
    return END_ESCAPED;
  }
  vertex.surface = surface_at(vertex.primitive, state.origin, state.direction, state.time);
  record_surface(vertex.surface);
  if (is_boundary(vertex.surface.material)) return cross_boundary(state, vertex.surface);
  if (state.depth == 1) return END_OCCLUDED;

  vertex.frame = make_frame(vertex.surface.shading_normal);
  vertex.wo = to_local(vertex.frame, -state.direction);
  vertex.parameters.model = MATERIAL_DIFFUSE;
  vertex.parameters.base_color = vec3(1.0);
  vertex.has_density = true;
  uvec4 bits = sampler_bits(state.key, scattering_dimension(state.segment));
  vec3 u = vec3(unit_interval(bits.x), unit_interval(bits.y), unit_interval(bits.z));
  precise BsdfSample scattered = vertex_sample(vertex, u);
  precise vec3 direction = to_world(vertex.frame, scattered.direction);
  bool leaves = on_its_side(vertex.surface, scattered, direction);
  record_scatter(bits, vertex, scattered, leaves, direction);
  if (!leaves) return END_SIDE;
  state.throughput = drop_negligible(state.throughput * scattered.weight);
  if (max_component(state.throughput) == 0.0) return END_ABSORBED;
  count_scattering(state.scattering_count, scattered.lobe);
  state.previous.position = vertex.surface.position;
  state.previous.density = 0.0;
  state.origin =
      offset_point(vertex.surface.position, vertex.surface.geometric_normal, vertex.surface.offset, direction);
  state.direction = direction;
  state.segment += 1;
  state.depth += 1;
  state.ray_length = render.occlusion_length;
  return CONTINUES;
}

#endif
