// Cut-outs and stochastic transparency: a triangle covers a fraction of the rays through each of its points, and a ray
// either meets it or does not notice it (Enderton et al., Stochastic Transparency, I3D 2010).

#ifndef TANDEM_GEOMETRY_OPACITY
#define TANDEM_GEOMETRY_OPACITY

#include "geometry/material_opacity.glsl"
#include "geometry/surface.glsl"
#include "geometry/triangle.glsl"
#include "random.glsl"
#include "scene.glsl"

/// The fraction of rays through this point of a triangle that it covers, in [0, 1].
precise float opacity_at(uint triangle_index, vec2 barycentrics) {
  if (!FEATURE_TRANSPARENCY) return 1.0;
  Triangle triangle = triangles[triangle_index];
  uint material = triangle.material & ~TRIANGLE_SMOOTH;
  vec4 uv = vec4(0.0);
  vec3 position = vec3(0.0);
  if (materials[material].alpha_texture != NO_TEXTURE) {
    uv = surface_texture_coordinates(material, triangle.vertices, barycentrics);
    position = barycentric_point(triangle_vertices(triangle.vertices), barycentrics);
  }
  float factor = FEATURE_TEXTURES ? surface_tint(material, triangle.vertices, barycentrics).w : 1.0;
  return material_opacity(material, uv, position, factor);
}

/// Whether a ray meets a triangle that lies on it. The answer depends on nothing else, so it is the same in a loop over
/// candidates and in an any-hit shader, and however often a device asks. `random` are 32 bits that belong to the ray;
/// together with the triangle they decide, so that triangles behind one another are met independently.
bool meets_triangle(uint triangle_index, vec3 origin, vec3 direction, uint random) {
  TriangleVertices vertices = triangle_vertices(triangles[triangle_index].vertices);
  precise float opacity = opacity_at(triangle_index, hit_barycentrics(vertices, origin, direction));
  return unit_interval(pcg4d(uvec4(random, triangle_index, 0, 0)).x) < opacity;
}

#endif
