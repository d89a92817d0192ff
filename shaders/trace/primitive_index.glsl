// What a device says of a hit, as an index into triangles.

#ifndef TANDEM_TRACE_PRIMITIVE_INDEX
#define TANDEM_TRACE_PRIMITIVE_INDEX

#include "scene.glsl"

const uint NO_PRIMITIVE = 0xffffffffu;

/// Instances hold consecutive triangles from their custom index on. Of an instance with two geometries the second holds
/// those from render.opaque_count on.
uint primitive_index(int instance_custom_index, int geometry_index, int index_in_geometry) {
  uint first = FEATURE_TRANSPARENCY && geometry_index != 0 ? render.opaque_count : 0u;
  return uint(instance_custom_index) + first + uint(index_in_geometry);
}

#endif
