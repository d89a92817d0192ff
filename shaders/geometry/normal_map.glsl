// Normal maps and bump maps: a texture bends the shading normal.

#ifndef TANDEM_GEOMETRY_NORMAL_MAP
#define TANDEM_GEOMETRY_NORMAL_MAP

#include "math.glsl"
#include "scene.glsl"
#include "texture/texture.glsl"

/// How a surface's point moves with its texture coordinates, or, where the vertices have tangents, with those of its normal
/// map; zero where that is not known.
struct SurfaceDerivatives {
  vec3 by_u;
  vec3 by_v;
};

/// Of a flat triangle with edges from its first vertex, along which the texture coordinates change by uv_b and uv_c.
precise SurfaceDerivatives triangle_derivatives(vec3 edge_b, vec3 edge_c, vec2 uv_b, vec2 uv_c) {
  SurfaceDerivatives derivatives;
  derivatives.by_u = vec3(0.0);
  derivatives.by_v = vec3(0.0);
  precise float determinant = uv_b.x * uv_c.y - uv_b.y * uv_c.x;
  if (!(abs(determinant) > 1e-20)) return derivatives;
  float inverse = det_div(1.0, determinant);
  derivatives.by_u = (edge_b * uv_c.y - edge_c * uv_b.y) * inverse;
  derivatives.by_v = (edge_c * uv_b.x - edge_b * uv_c.x) * inverse;
  return derivatives;
}

bool has_normal_map(uint material) {
  if (!FEATURE_TEXTURES) return false;
  return materials[material].normal_texture != NO_TEXTURE || materials[material].bump_texture != NO_TEXTURE;
}

/// The normal map, or without one the bump map, of a material that has either.
uint bending_texture(uint material) {
  uint map = materials[material].normal_texture;
  return map != NO_TEXTURE ? map : materials[material].bump_texture;
}

/// The unit normal that a material's normal map, or without one its bump map (an image), makes of `normal` where the
/// vertices' texture coordinates are uv. All is seen from the side of the triangle's own normal.
precise vec3 mapped_normal(uint material, vec3 normal, SurfaceDerivatives derivatives, vec4 uv, vec3 position) {
  bool is_bump = materials[material].normal_texture == NO_TEXTURE;
  uint texture_index = bending_texture(material);
  if (is_bump && textures[texture_index].kind != TEXTURE_IMAGE) return normal;

  // Derivatives with respect to the texture's own coordinates s and t: the inverse of its transform's linear part.
  vec3 u_row = textures[texture_index].u_row;
  vec3 v_row = textures[texture_index].v_row;
  precise float determinant = u_row.x * v_row.y - u_row.y * v_row.x;
  if (!(abs(determinant) > 1e-20)) return normal;
  float inverse = det_div(1.0, determinant);
  precise vec3 by_s = (derivatives.by_u * v_row.y - derivatives.by_v * v_row.x) * inverse;
  precise vec3 by_t = (derivatives.by_v * u_row.x - derivatives.by_u * u_row.y) * inverse;
  if ((materials[material].attributes & ATTRIBUTE_TANGENT) != 0) {
    by_s = derivatives.by_u;
    by_t = derivatives.by_v;
  }
  // Its directions in the tangent plane, along which the other coordinate stays the same but for the skew.
  vec3 along_s = det_normalize(by_s - normal * det_dot(normal, by_s), vec3(0.0));
  vec3 across_s = det_cross(normal, along_s);
  precise float mirrored = det_dot(across_s, by_t);
  if (!(abs(mirrored) > 1e-20)) return normal;
  vec3 along_t = mirrored < 0.0 ? -across_s : across_s;

  // One place that reads the texture: once for a normal, half a texel to each side for the slopes of heights.
  vec2 texel = vec2(det_div(1.0, float(textures[texture_index].width)),
                    det_div(1.0, float(textures[texture_index].height)));
  vec2 st = texture_transform(texture_index, uv);
  vec4 sum = vec4(0.0);
  float slope_s = 0.0;
  float slope_t = 0.0;
  uint tap_count = is_bump ? 4 : 1;
  for (uint tap = 0; tap < tap_count; ++tap) {
    vec2 place = st;
    float side = (tap & 1u) != 0 ? 0.5 : -0.5;
    if (is_bump && tap < 2) place.x += side * texel.x;
    if (is_bump && tap >= 2) place.y += side * texel.y;
    sum = texture_at_own(texture_index, place, position);
    float height = texture_channel(texture_index, sum);
    float difference = (tap & 1u) != 0 ? height : -height;
    if (tap < 2) slope_s += difference;
    if (tap >= 2) slope_t += difference;
  }
  float scale = materials[material].normal_scale;
  if (!is_bump) {
    vec3 local = sum.xyz * 2.0 - vec3(1.0);
    return det_normalize((along_s * (local.x * scale) + along_t * (local.y * scale)) + normal * local.z, normal);
  }
  // A surface p + h n has the derivatives p_s + h_s n and p_t + h_t n (Blinn, Simulation of Wrinkled Surfaces, 1978),
  // whose cross product is, but for a factor, n minus the gradient of h along the surface.
  float height_s = slope_s * float(textures[texture_index].width) * scale;
  float height_t = slope_t * float(textures[texture_index].height) * scale;
  precise float area = det_dot(det_cross(by_s, by_t), normal);
  if (!(abs(area) > 1e-30)) return normal;
  vec3 gradient = det_cross(by_t, normal) * height_s + det_cross(normal, by_s) * height_t;
  return det_normalize(normal - gradient * det_div(1.0, area), normal);
}

#endif
