// How a ray is traced, and the only file that knows. An entry point says by macros which way is meant:
//   TANDEM_TRACE_PIPELINE  a ray tracing pipeline, else ray queries
//   TANDEM_EVENTS          every ray and its answer is recorded (integrator/events.glsl); it changes neither
// Both ways give the same answers, to the last bit: what decides whether a triangle counts depends on the ray and the
// triangle only (geometry/opacity.glsl), not on the order in which a device offers them.

#ifndef TANDEM_TRACE
#define TANDEM_TRACE

#include "trace/primitive_index.glsl"

// Farther than anything in a scene of floats whose squares are floats.
const float RAY_LENGTH = 1e30;

#ifdef TANDEM_TRACE_PIPELINE
#include "trace/pipeline.glsl"
#else
#include "trace/query.glsl"
#endif

#include "integrator/events.glsl"
#include "trace/traced_ray.glsl"

/// Index of the closest primitive along a ray, or NO_PRIMITIVE. `t_max` in lengths of the direction. The dimension
/// belongs to this ray alone: it decides which transparent triangles the ray meets.
uint trace_closest(vec3 origin, vec3 direction, float t_max, RandomKey key, uint dimension) {
  uint primitive = closest_primitive(origin, direction, t_max, key, dimension);
  TANDEM_RECORD(event_ray(RAY_CLOSEST, dimension, origin, t_max, direction, primitive, reported_hit);)
  return primitive;
}

/// Whether there is anything along a ray. The parameters as for trace_closest.
bool trace_occluded(vec3 origin, vec3 direction, float t_max, RandomKey key, uint dimension) {
  bool occluded = is_occluded(origin, direction, t_max, key, dimension);
  TANDEM_RECORD(event_ray(RAY_OCCLUSION, dimension, origin, t_max, direction, occluded ? 1u : 0u, no_reported_hit());)
  return occluded;
}

#endif
