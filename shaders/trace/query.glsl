// Tracing by ray queries.

#ifndef TANDEM_TRACE_QUERY
#define TANDEM_TRACE_QUERY

#include "geometry/opacity.glsl"
#include "random.glsl"
#include "trace/triangle_index.glsl"

#ifdef TANDEM_TRANSPARENCY
const uint OPACITY_FLAGS = gl_RayFlagsNoneEXT;
#else
const uint OPACITY_FLAGS = gl_RayFlagsOpaqueEXT;
#endif

/// Index of the closest triangle along a ray, or NO_TRIANGLE. The dimension belongs to this ray alone: it decides which
/// transparent triangles the ray meets.
uint closest_triangle(vec3 origin, vec3 direction, float t_max, RandomKey key, uint dimension) {
#ifdef TANDEM_TRANSPARENCY
  uint random = random_bits(key, dimension).x;
#endif
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene_tlas, OPACITY_FLAGS, 0xff, origin, 0.0, direction, t_max);
  while (rayQueryProceedEXT(query)) {
#ifdef TANDEM_TRANSPARENCY
    uint candidate = triangle_index(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false),
                                    rayQueryGetIntersectionGeometryIndexEXT(query, false),
                                    rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
    if (meets_triangle(candidate, origin, direction, random)) rayQueryConfirmIntersectionEXT(query);
#endif
  }
  if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionTriangleEXT) return NO_TRIANGLE;
  return triangle_index(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),
                        rayQueryGetIntersectionGeometryIndexEXT(query, true),
                        rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
}

/// Whether there is any triangle along a ray. The dimension as for closest_triangle.
bool is_occluded(vec3 origin, vec3 direction, float t_max, RandomKey key, uint dimension) {
#ifdef TANDEM_TRANSPARENCY
  uint random = random_bits(key, dimension).x;
#endif
  const uint flags = OPACITY_FLAGS | gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene_tlas, flags, 0xff, origin, 0.0, direction, t_max);
  while (rayQueryProceedEXT(query)) {
#ifdef TANDEM_TRANSPARENCY
    uint candidate = triangle_index(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false),
                                    rayQueryGetIntersectionGeometryIndexEXT(query, false),
                                    rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
    if (meets_triangle(candidate, origin, direction, random)) rayQueryConfirmIntersectionEXT(query);
#endif
  }
  return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
}

#endif
