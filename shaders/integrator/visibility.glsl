// What is left of light between two points.

#ifndef TANDEM_INTEGRATOR_VISIBILITY
#define TANDEM_INTEGRATOR_VISIBILITY

#include "geometry/surface.glsl"
#include "integrator/medium.glsl"
#include "trace.glsl"

// A ray that crosses more boundaries of media than this is ended: paths stay finite whatever rounding does.
const uint MAX_CROSSINGS = 64;

/// Whether a surface is nothing but the boundary of a medium.
bool is_boundary(uint material) { return FEATURE_MEDIA && materials[material].model == MATERIAL_BOUNDARY; }

/// The fraction of light that gets from one point to another, or along a ray without end: 0 where a surface is in
/// between. Boundaries of media are none. `medium`: at the origin. The dimension as for trace_occluded.
/// @param direction not 0; its length counts for `t_max` @param t_max 1 or RAY_LENGTH
precise vec3 visibility(vec3 origin, vec3 direction, float t_max, uint medium, float time, RandomKey key,
                        uint dimension, inout uint ray_count) {
  if (!FEATURE_MEDIA) {
    ray_count += 1;
    return trace_occluded(origin, direction, t_max, key, dimension) ? vec3(0.0) : vec3(1.0);
  }
  precise vec3 end = origin + direction;
  precise vec3 left = vec3(1.0);
  for (uint crossing = 0; crossing < MAX_CROSSINGS; ++crossing) {
    ray_count += 1;
    TANDEM_RECORD(flush_events();)  // the segment's own ray waits in the same place
    uint primitive = trace_closest(origin, direction, t_max, key, dimension);
    if (primitive == NO_PRIMITIVE) {
      left *= medium_transmittance(medium, t_max == 1.0 ? det_length(direction) : RAY_LENGTH);
      return drop_negligible(left);
    }
    precise Surface surface = surface_at(primitive, origin, det_normalize(direction, vec3(0.0, 0.0, 1.0)), time);
    if (!is_boundary(surface.material)) return vec3(0.0);
    precise vec3 segment = surface.position - origin;
    left *= medium_transmittance(medium, det_length(segment));
    left = drop_negligible(left);
    medium = medium_beyond(surface.material, surface.outside);
    origin = offset_point(surface.position, surface.geometric_normal, surface.offset, direction);
    if (t_max == 1.0) {
      precise vec3 rest = end - origin;
      // The boundary is where the light is.
      if (!(det_dot(rest, direction) > 0.0)) return left;
      direction = rest;
    }
  }
  return vec3(0.0);
}

#endif
