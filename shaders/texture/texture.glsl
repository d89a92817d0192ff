// What a texture's kind makes of a place on a surface.

#ifndef TANDEM_TEXTURE_TEXTURE
#define TANDEM_TEXTURE_TEXTURE

#include "math.glsl"
#include "scene.glsl"
#include "texture/checker.glsl"
#include "texture/image.glsl"
#include "texture/noise.glsl"

/// Of a surface that has but one set.
vec4 both_sets(vec2 uv) { return vec4(uv, uv); }

/// A texture's own coordinates where the two sets of the vertices' are uv.
precise vec2 texture_transform(uint texture_index, vec4 sets) {
  vec2 uv = FEATURE_TEXTURES && textures[texture_index].coordinates != 0 ? sets.zw : sets.xy;
  vec3 u_row = textures[texture_index].u_row;
  vec3 v_row = textures[texture_index].v_row;
  return vec2((u_row.x * uv.x + u_row.y * uv.y) + u_row.z, (v_row.x * uv.x + v_row.y * uv.y) + v_row.z);
}

/// r, g, b and alpha at a texture's own coordinates and a point in world space.
precise vec4 texture_at_own(uint texture_index, vec2 st, vec3 position) {
  vec4 a = vec4(textures[texture_index].color_a, textures[texture_index].alpha_a);
  uint kind = textures[texture_index].kind;
  if (!FEATURE_TEXTURES || kind == TEXTURE_IMAGE) return image_at(texture_index, st) * a;
  if (kind == TEXTURE_UNIFORM) return a;
  vec4 b = vec4(textures[texture_index].color_b, textures[texture_index].alpha_b);
  float scale = textures[texture_index].scale;
  if (kind == TEXTURE_CHECKER) return is_second_square(st * scale) ? b : a;
  return a + (b - a) * turbulence(position * scale);
}

/// r, g, b and alpha at texture coordinates (v = 0 is the lower edge), two sets of them, and a point in world space; 1 for NO_TEXTURE.
precise vec4 texture_at(uint texture_index, vec4 uv, vec3 position) {
  if (texture_index == NO_TEXTURE) return vec4(1.0);
  return texture_at_own(texture_index, texture_transform(texture_index, uv), position);
}

precise vec3 texture_color(uint texture_index, vec4 uv, vec3 position) {
  return texture_at(texture_index, uv, position).xyz;
}

/// The number that a texture's channel says, of what texture_at gives.
precise float texture_channel(uint texture_index, vec4 value) {
  switch (textures[texture_index].channel) {
    case 0:
      return value.x;
    case 1:
      return value.y;
    case 2:
      return value.z;
    case 3:
      return value.w;
    default:
      return (0.2126 * value.x + 0.7152 * value.y) + 0.0722 * value.z;
  }
}

/// The number that the texture's channel holds; 1 for NO_TEXTURE.
precise float texture_value(uint texture_index, vec4 uv, vec3 position) {
  if (texture_index == NO_TEXTURE) return 1.0;
  return texture_channel(texture_index, texture_at(texture_index, uv, position));
}

#endif
