// Radiance that surfaces emit, the same to all directions on both sides.

#ifndef TANDEM_LIGHT_EMISSION
#define TANDEM_LIGHT_EMISSION

#include "math.glsl"
#include "scene.glsl"
#include "texture/texture.glsl"

/// @param uv, position where: what textures are read at @param tint of the vertices
precise vec3 emitted_radiance(uint material, vec4 uv, vec3 position, vec3 tint) {
  vec3 radiance = materials[material].emission;
  // Most surfaces emit nothing: their textures are not worth a look.
  if (!FEATURE_TEXTURES || max_component(radiance) == 0.0) return radiance;
  if ((materials[material].attributes & ATTRIBUTE_EMISSION) != 0) radiance *= tint;
  return radiance * texture_color(materials[material].emission_texture, uv, position);
}

/// Solid-angle density, seen from `position`, of a point that is sampled on a surface with that density per area.
/// @param direction unit, from the position to the point @param normal unit, of either side
precise float solid_angle_density(float area_density, vec3 position, vec3 direction, vec3 point, vec3 normal) {
  precise vec3 to_point = point - position;
  precise float cosine = abs(det_dot(direction, normal));
  // Less is rounding: the surface is seen edge-on.
  if (!(cosine > 1e-7)) return 0.0;
  return det_div(area_density * det_dot(to_point, to_point), cosine);
}

#endif
