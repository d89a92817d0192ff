// What a device says of a hit, as the index of a primitive: triangles come first, then spheres.

#ifndef TANDEM_TRACE_PRIMITIVE_INDEX
#define TANDEM_TRACE_PRIMITIVE_INDEX

#include "scene.glsl"

const uint NO_PRIMITIVE = 0xffffffffu;

/// The instance with custom index 0 holds all triangles, in its second geometry those from render.opaque_count on; that
/// with custom index 1 holds all spheres.
uint primitive_index(int instance_custom_index, int geometry_index, int index_in_geometry) {
  uint first = FEATURE_TRANSPARENCY && geometry_index != 0 ? render.opaque_count : 0u;
  if (FEATURE_SPHERES && instance_custom_index != 0) first = render.triangle_count;
  return first + uint(index_in_geometry);
}

#endif
