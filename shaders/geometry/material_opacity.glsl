// What a material says of opacity, for surfaces of every shape.

#ifndef TANDEM_GEOMETRY_MATERIAL_OPACITY
#define TANDEM_GEOMETRY_MATERIAL_OPACITY

#include "scene.glsl"
#include "texture/texture.glsl"

/// The fraction of rays through a point that a surface of this material covers, in [0, 1]. Without
/// an alpha texture texture coordinates and position do not matter. `factor`: of the vertices.
precise float material_opacity(uint material, vec4 uv, vec3 position, float factor) {
  float opacity = materials[material].opacity * factor;
  uint texture_index = materials[material].alpha_texture;
  if (texture_index != NO_TEXTURE) opacity *= texture_value(texture_index, uv, position);
  float cutoff = materials[material].alpha_cutoff;
  if (cutoff > 0.0) return opacity >= cutoff ? 1.0 : 0.0;
  return opacity;
}

#endif
