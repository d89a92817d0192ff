// How a ray is traced, and the only file that knows. An entry point says by macros which way is meant:
//   TANDEM_TRACE_PIPELINE  a ray tracing pipeline, else ray queries
//   TANDEM_RAY_LOG         every ray and its answer is written down; it changes neither
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

#ifdef TANDEM_RAY_LOG
#include "trace/ray_log.glsl"
#endif

/// Index of the closest primitive along a ray, or NO_PRIMITIVE. The dimension belongs to this ray alone: it decides which
/// transparent triangles the ray meets.
uint trace_closest(vec3 origin, vec3 direction, RandomKey key, uint dimension) {
  uint primitive = closest_primitive(origin, direction, RAY_LENGTH, key, dimension);
#ifdef TANDEM_RAY_LOG
  log_ray(TracedRay(origin, RAY_LENGTH, direction, RAY_CLOSEST, primitive, key.pixel, key.sample_index, dimension));
#endif
  return primitive;
}

/// Whether anything lies between two points. The dimension as for trace_closest.
bool trace_occluded(vec3 from, vec3 to, RandomKey key, uint dimension) {
  precise vec3 direction = to - from;
  bool occluded = is_occluded(from, direction, 1.0, key, dimension);
#ifdef TANDEM_RAY_LOG
  log_ray(TracedRay(from, 1.0, direction, RAY_OCCLUSION, occluded ? 1u : 0u, key.pixel, key.sample_index, dimension));
#endif
  return occluded;
}

#endif
