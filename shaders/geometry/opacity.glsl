// Cut-outs and stochastic transparency: a triangle covers a fraction of the rays through each of its points, and a ray
// either meets it or does not notice it (Enderton et al., Stochastic Transparency, I3D 2010).

#ifndef TANDEM_GEOMETRY_OPACITY
#define TANDEM_GEOMETRY_OPACITY

#include "geometry/surface.glsl"
#include "geometry/triangle.glsl"
#include "random.glsl"
#include "scene.glsl"

#ifdef TANDEM_TRANSPARENCY

/// Index of the texel, out of `count`, at a texture coordinate that repeats with period 1.
precise uint repeated_texel(float coordinate, uint count) {
  float fraction = coordinate - floor(coordinate);
  uint texel = uint(fraction * float(count));
  return texel < count ? texel : count - 1;
}

/// The nearest texel, in [0, 1]; v = 0 is the lower edge.
precise float sample_alpha(uint texture_index, vec2 uv) {
  AlphaTexture image = alpha_textures[texture_index];
  uint column = repeated_texel(uv.x, image.width);
  uint row = image.height - 1 - repeated_texel(uv.y, image.height);
  uint texel = image.first_texel + row * image.width + column;
  uint alpha = (alpha_texels[texel >> 2] >> (8 * (texel & 3u))) & 0xffu;
  return float(alpha) * 0.00392156886;  // 255 gives 1
}

vec2 vertex_texture_coordinates(uint vertex) {
  return vec2(texture_coordinates[2 * vertex], texture_coordinates[2 * vertex + 1]);
}

/// The fraction of rays through this point of a triangle that it covers, in [0, 1].
precise float opacity_at(uint triangle_index, vec2 barycentrics) {
  Triangle triangle = triangles[triangle_index];
  uint material = triangle.material & ~TRIANGLE_SMOOTH;
  float opacity = materials[material].opacity;
  uint texture_index = materials[material].alpha_texture;
  if (texture_index == NO_TEXTURE) return opacity;
  precise vec2 uv = (vertex_texture_coordinates(triangle.vertices.x) * ((1.0 - barycentrics.x) - barycentrics.y) +
                     vertex_texture_coordinates(triangle.vertices.y) * barycentrics.x) +
                    vertex_texture_coordinates(triangle.vertices.z) * barycentrics.y;
  return opacity * sample_alpha(texture_index, uv);
}

/// Whether a ray meets a triangle that lies on it. The answer depends on nothing else, so it is the same in a loop over
/// candidates and in an any-hit shader, and however often a device asks. `random` are 32 bits that belong to the ray;
/// together with the triangle they decide, so that triangles behind one another are met independently.
bool meets_triangle(uint triangle_index, vec3 origin, vec3 direction, uint random) {
  TriangleVertices vertices = triangle_vertices(triangles[triangle_index].vertices);
  precise float opacity = opacity_at(triangle_index, hit_barycentrics(vertices, origin, direction));
  return unit_interval(pcg4d(uvec4(random, triangle_index, 0, 0)).x) < opacity;
}

#else

float opacity_at(uint triangle_index, vec2 barycentrics) { return 1.0; }

#endif

#endif
