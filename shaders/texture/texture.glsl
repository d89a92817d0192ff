// Textures are read by exact fetches from a buffer and filtered here, so that every device agrees.

#ifndef TANDEM_TEXTURE_TEXTURE
#define TANDEM_TEXTURE_TEXTURE

#include "math.glsl"
#include "scene.glsl"

/// Index of the texel, out of `count`, at a texture coordinate that repeats with period 1.
precise uint repeated_texel(float coordinate, uint count) {
  float fraction = coordinate - floor(coordinate);
  uint texel = uint(fraction * float(count));
  return texel < count ? texel : count - 1;
}

/// r, g, b and alpha at a texture coordinate (v = 0 is the lower edge) and a point in world space; 1 for NO_TEXTURE.
precise vec4 texture_at(uint texture_index, vec2 uv, vec3 position) {
  if (texture_index == NO_TEXTURE) return vec4(1.0);
  Texture image = textures[texture_index];
  uint column = repeated_texel(uv.x, image.width);
  uint row = image.height - 1 - repeated_texel(uv.y, image.height);
  uint texel = image.first_word + row * image.width + column;
  uint alpha = (texels[texel >> 2] >> (8 * (texel & 3u))) & 0xffu;
  return vec4(float(alpha) * 0.00392156886);  // 255 gives 1
}

precise vec3 texture_color(uint texture_index, vec2 uv, vec3 position) {
  return texture_at(texture_index, uv, position).xyz;
}

/// The number that the texture's channel holds.
precise float texture_value(uint texture_index, vec2 uv, vec3 position) {
  return texture_at(texture_index, uv, position).x;
}

#endif
