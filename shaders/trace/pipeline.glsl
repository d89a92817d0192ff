// Tracing through a ray tracing pipeline, from its ray generation shader. The functions are those of trace/query.glsl.

#ifndef TANDEM_TRACE_PIPELINE_FORM
#define TANDEM_TRACE_PIPELINE_FORM

#include "camera/shutter.glsl"
#include "random.glsl"
#include "scene.glsl"
#include "trace/payload.glsl"
#include "trace/primitive_index.glsl"
#include "trace/ray_time.glsl"

layout(location = 0) rayPayloadEXT RayPayload ray_payload;
#ifdef TANDEM_EVENTS
// By the last call of closest_primitive.
ReportedHit reported_hit;
#endif

const uint OPACITY_FLAGS = FEATURE_TRANSPARENCY ? gl_RayFlagsNoneEXT : gl_RayFlagsOpaqueEXT;

/// The time goes to path_trace.rint as the ray's t_min.
precise float ray_t_min(RandomKey key) { return FEATURE_SPHERES ? t_min_of_time(shutter_time(key)) : 0.0; }

uint closest_primitive(vec3 origin, vec3 direction, float t_max, RandomKey key, uint dimension) {
  ray_payload.primitive = NO_PRIMITIVE;
  if (FEATURE_TRANSPARENCY) ray_payload.random = random_bits(key, dimension).x;
  traceRayEXT(scene_tlas, OPACITY_FLAGS, 0xff, 0, 0, 0, origin, ray_t_min(key), direction, t_max, 0);
#ifdef TANDEM_EVENTS
  reported_hit = no_reported_hit();
  if (ray_payload.primitive != NO_PRIMITIVE) reported_hit = ray_payload.hit;
#endif
  return ray_payload.primitive;
}

bool is_occluded(vec3 origin, vec3 direction, float t_max, RandomKey key, uint dimension) {
  const uint flags = OPACITY_FLAGS | gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;
  // No closest-hit shader runs: what the miss shader does not change is a hit.
  ray_payload.primitive = 0;
  if (FEATURE_TRANSPARENCY) ray_payload.random = random_bits(key, dimension).x;
  traceRayEXT(scene_tlas, flags, 0xff, 0, 0, 0, origin, ray_t_min(key), direction, t_max, 0);
  return ray_payload.primitive != NO_PRIMITIVE;
}

#endif
