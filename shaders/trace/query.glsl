// Tracing by ray queries.

#ifndef TANDEM_TRACE_QUERY
#define TANDEM_TRACE_QUERY

#include "camera/shutter.glsl"
#include "geometry/opacity.glsl"
#include "geometry/sphere_hit.glsl"
#include "random.glsl"
#include "trace/primitive_index.glsl"
#ifdef TANDEM_EVENTS
#include "trace/reported_hit.glsl"

// By the last call of closest_primitive.
ReportedHit reported_hit;
#endif

const uint OPACITY_FLAGS = FEATURE_TRANSPARENCY ? gl_RayFlagsNoneEXT : gl_RayFlagsOpaqueEXT;

// Both functions below have this loop: a query cannot be handed to a function on every device. What is generated must lie
// before what is committed.
#define TANDEM_PROCEED(query)                                                                                        \
  while (rayQueryProceedEXT(query)) {                                                                                \
    if (FEATURE_SPHERES &&                                                                                           \
        rayQueryGetIntersectionTypeEXT(query, false) == gl_RayQueryCandidateIntersectionAABBEXT) {                   \
      uint sphere_index = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false));                              \
      precise float t = sphere_hit(sphere_index, origin, direction, time);                                           \
      bool committed = rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;       \
      float bound = committed ? rayQueryGetIntersectionTEXT(query, true) : t_max;                                    \
      if (t > 0.0 && t <= bound) rayQueryGenerateIntersectionEXT(query, t);                                          \
    } else if (FEATURE_TRANSPARENCY) {                                                                               \
      uint candidate = primitive_index(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false),                  \
                                       rayQueryGetIntersectionGeometryIndexEXT(query, false),                        \
                                       rayQueryGetIntersectionPrimitiveIndexEXT(query, false));                      \
      if (meets_triangle(candidate, origin, direction, random)) rayQueryConfirmIntersectionEXT(query);               \
    }                                                                                                                \
  }

/// Index of the closest primitive along a ray, or NO_PRIMITIVE. The dimension belongs to this ray alone: it decides which
/// transparent triangles the ray meets.
uint closest_primitive(vec3 origin, vec3 direction, float t_max, RandomKey key, uint dimension) {
  uint random = FEATURE_TRANSPARENCY ? random_bits(key, dimension).x : 0u;
  precise float time = FEATURE_SPHERES ? shutter_time(key) : 0.0;
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene_tlas, OPACITY_FLAGS, 0xff, origin, 0.0, direction, t_max);
  TANDEM_PROCEED(query)
#ifdef TANDEM_EVENTS
  reported_hit = no_reported_hit();
#endif
  if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT) return NO_PRIMITIVE;
#ifdef TANDEM_EVENTS
  reported_hit.instance_custom_index = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true));
  reported_hit.geometry_index = uint(rayQueryGetIntersectionGeometryIndexEXT(query, true));
  reported_hit.primitive_index = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
  reported_hit.t = rayQueryGetIntersectionTEXT(query, true);
  reported_hit.kind = HIT_PROCEDURAL;
  if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT) {
    reported_hit.kind = rayQueryGetIntersectionFrontFaceEXT(query, true) ? HIT_FRONT : HIT_BACK;
    reported_hit.barycentrics = rayQueryGetIntersectionBarycentricsEXT(query, true);
  }
#endif
  return primitive_index(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),
                         rayQueryGetIntersectionGeometryIndexEXT(query, true),
                         rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
}

/// Whether there is any primitive along a ray. The dimension as for closest_primitive.
bool is_occluded(vec3 origin, vec3 direction, float t_max, RandomKey key, uint dimension) {
  uint random = FEATURE_TRANSPARENCY ? random_bits(key, dimension).x : 0u;
  precise float time = FEATURE_SPHERES ? shutter_time(key) : 0.0;
  const uint flags = OPACITY_FLAGS | gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene_tlas, flags, 0xff, origin, 0.0, direction, t_max);
  TANDEM_PROCEED(query)
  return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
}

#endif
