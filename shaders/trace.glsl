// How a ray is traced. The only file that knows: another form (ray tracing pipelines) replaces this one.

#ifndef TANDEM_TRACE
#define TANDEM_TRACE

#include "scene.glsl"

const uint NO_TRIANGLE = 0xffffffffu;

// Farther than anything in a scene of floats whose squares are floats.
const float RAY_LENGTH = 1e30;

/// Index of the closest triangle along a ray, or NO_TRIANGLE. Instances hold consecutive triangles from their custom
/// index on.
uint trace_closest(vec3 origin, vec3 direction) {
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene_tlas, gl_RayFlagsOpaqueEXT, 0xff, origin, 0.0, direction, RAY_LENGTH);
  while (rayQueryProceedEXT(query)) {
  }
  if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionTriangleEXT) return NO_TRIANGLE;
  return uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true)) +
         uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
}

/// Whether anything lies between two points.
bool trace_occluded(vec3 from, vec3 to) {
  precise vec3 direction = to - from;
  const uint flags = gl_RayFlagsOpaqueEXT | gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene_tlas, flags, 0xff, from, 0.0, direction, 1.0);
  while (rayQueryProceedEXT(query)) {
  }
  return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
}

#endif
