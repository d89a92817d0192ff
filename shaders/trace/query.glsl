// Tracing by ray queries.

#ifndef TANDEM_TRACE_QUERY
#define TANDEM_TRACE_QUERY

#include "geometry/opacity.glsl"
#include "random.glsl"
#include "trace/primitive_index.glsl"

const uint OPACITY_FLAGS = FEATURE_TRANSPARENCY ? gl_RayFlagsNoneEXT : gl_RayFlagsOpaqueEXT;

/// Index of the closest triangle along a ray, or NO_PRIMITIVE. The dimension belongs to this ray alone: it decides which
/// transparent triangles the ray meets.
uint closest_primitive(vec3 origin, vec3 direction, float t_max, RandomKey key, uint dimension) {
  uint random = FEATURE_TRANSPARENCY ? random_bits(key, dimension).x : 0u;
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene_tlas, OPACITY_FLAGS, 0xff, origin, 0.0, direction, t_max);
  while (rayQueryProceedEXT(query)) {
    if (!FEATURE_TRANSPARENCY) continue;
    uint candidate = primitive_index(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false),
                                    rayQueryGetIntersectionGeometryIndexEXT(query, false),
                                    rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
    if (meets_triangle(candidate, origin, direction, random)) rayQueryConfirmIntersectionEXT(query);
  }
  if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionTriangleEXT) return NO_PRIMITIVE;
  return primitive_index(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),
                        rayQueryGetIntersectionGeometryIndexEXT(query, true),
                        rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
}

/// Whether there is any triangle along a ray. The dimension as for closest_primitive.
bool is_occluded(vec3 origin, vec3 direction, float t_max, RandomKey key, uint dimension) {
  uint random = FEATURE_TRANSPARENCY ? random_bits(key, dimension).x : 0u;
  const uint flags = OPACITY_FLAGS | gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene_tlas, flags, 0xff, origin, 0.0, direction, t_max);
  while (rayQueryProceedEXT(query)) {
    if (!FEATURE_TRANSPARENCY) continue;
    uint candidate = primitive_index(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false),
                                    rayQueryGetIntersectionGeometryIndexEXT(query, false),
                                    rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
    if (meets_triangle(candidate, origin, direction, random)) rayQueryConfirmIntersectionEXT(query);
  }
  return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
}

#endif
