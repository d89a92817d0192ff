// Surfaces that are nothing but the boundary of a medium, on the way of a path.

#ifndef TANDEM_INTEGRATOR_BOUNDARY
#define TANDEM_INTEGRATOR_BOUNDARY

#include "geometry/surface.glsl"
#include "integrator/path_state.glsl"
#include "integrator/visibility.glsl"

/// Goes on behind the boundary: it ends a segment, but adds nothing to the depth. CONTINUES, or END_CROSSINGS.
uint cross_boundary(inout precise PathState state, Surface surface) {
  state.medium = medium_beyond(surface.material, surface.outside);
  state.origin = offset_point(surface.position, surface.geometric_normal, surface.offset, state.direction);
  if (state.segment - state.depth == MAX_CROSSINGS) return END_CROSSINGS;
  state.segment += 1;
  return CONTINUES;
}

#endif
