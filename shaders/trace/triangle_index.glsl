// What a device says of a hit, as an index into triangles.

#ifndef TANDEM_TRACE_TRIANGLE_INDEX
#define TANDEM_TRACE_TRIANGLE_INDEX

#include "scene.glsl"

const uint NO_TRIANGLE = 0xffffffffu;

/// Instances hold consecutive triangles from their custom index on. Of an instance with two geometries the second holds
/// those from render.opaque_count on.
uint triangle_index(int instance_custom_index, int geometry_index, int primitive_index) {
#ifdef TANDEM_TRANSPARENCY
  uint first = geometry_index != 0 ? render.opaque_count : 0u;
#else
  const uint first = 0;
#endif
  return uint(instance_custom_index) + first + uint(primitive_index);
}

#endif
