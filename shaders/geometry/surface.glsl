// The surface at a hit. The device only says which triangle a ray meets; where, and with which normals, is computed from
// the vertices, the same way on every device.

#ifndef TANDEM_GEOMETRY_SURFACE
#define TANDEM_GEOMETRY_SURFACE

#include "geometry/normal_map.glsl"
#include "geometry/offset_ray.glsl"
#include "geometry/triangle.glsl"
#include "scene.glsl"

vec3 vertex_position(uint vertex) {
  return vec3(positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]);
}

vec3 vertex_normal(uint vertex) {
  return vec3(normals[3 * vertex], normals[3 * vertex + 1], normals[3 * vertex + 2]);
}

TriangleVertices triangle_vertices(uvec3 vertices) {
  return TriangleVertices(vertex_position(vertices.x), vertex_position(vertices.y), vertex_position(vertices.z));
}

vec2 vertex_texture_coordinates(uint vertex) {
  return vec2(texture_coordinates[2 * vertex], texture_coordinates[2 * vertex + 1]);
}

precise vec2 surface_texture_coordinates(uvec3 vertices, vec2 barycentrics) {
  return (vertex_texture_coordinates(vertices.x) * ((1.0 - barycentrics.x) - barycentrics.y) +
          vertex_texture_coordinates(vertices.y) * barycentrics.x) +
         vertex_texture_coordinates(vertices.z) * barycentrics.y;
}

/// How the texture coordinates of a triangle go with its points.
precise SurfaceDerivatives surface_derivatives(uvec3 vertices, TriangleVertices triangle) {
  vec2 uv = vertex_texture_coordinates(vertices.x);
  return triangle_derivatives(triangle.b - triangle.a, triangle.c - triangle.a,
                              vertex_texture_coordinates(vertices.y) - uv,
                              vertex_texture_coordinates(vertices.z) - uv);
}

struct Surface {
  vec3 position;
  vec3 geometric_normal;  // unit, on the side from which the ray came
  vec3 shading_normal;    // unit, likewise
  float offset;           // offset_distance of the position
  bool outside;           // the ray came from the side of the triangle's own (counter-clockwise) normal
  uint material;
  vec2 texture_coordinates;  // with FEATURE_TEXTURES
};

/// The surface where a ray meets a primitive. `direction` has unit length; `time` in [0, 1] since the shutter opened.
precise Surface surface_at(uint primitive, vec3 origin, vec3 direction, float time) {
  uvec3 vertices = triangles[primitive].vertices;
  uint material = triangles[primitive].material;
  TriangleVertices triangle = triangle_vertices(vertices);
  vec2 barycentrics = hit_barycentrics(triangle, origin, direction);
  precise vec3 normal = triangle_normal(triangle, -direction);

  Surface surface;
  surface.material = material & ~TRIANGLE_SMOOTH;
  surface.position = barycentric_point(triangle, barycentrics);
  surface.outside = det_dot(normal, direction) <= 0.0;
  surface.geometric_normal = surface.outside ? normal : -normal;
  surface.shading_normal = surface.geometric_normal;
  surface.offset = offset_distance(surface.position, normal, triangle_extent(triangle));

  surface.texture_coordinates =
      FEATURE_TEXTURES ? surface_texture_coordinates(vertices, barycentrics) : vec2(0.0);

  if ((material & TRIANGLE_SMOOTH) != 0) {
    precise vec3 interpolated = (vertex_normal(vertices.x) * ((1.0 - barycentrics.x) - barycentrics.y) +
                                 vertex_normal(vertices.y) * barycentrics.x) +
                                vertex_normal(vertices.z) * barycentrics.y;
    precise vec3 smooth_normal = det_normalize(interpolated, surface.geometric_normal);
    if (det_dot(smooth_normal, surface.geometric_normal) < 0.0) smooth_normal = -smooth_normal;
    // Seen from behind an interpolated normal means nothing: near silhouettes the geometric one takes over.
    if (det_dot(smooth_normal, direction) < 0.0) surface.shading_normal = smooth_normal;
  }
  if (has_normal_map(surface.material)) {
    precise vec3 front = surface.outside ? surface.shading_normal : -surface.shading_normal;
    precise vec3 mapped = mapped_normal(surface.material, front, surface_derivatives(vertices, triangle),
                                        surface.texture_coordinates, surface.position);
    if (!surface.outside) mapped = -mapped;
    // Seen from behind, or turned into the surface, it means as little as an interpolated one.
    bool meaningful = det_dot(mapped, direction) < 0.0 && det_dot(mapped, surface.geometric_normal) > 0.0;
    if (meaningful) surface.shading_normal = mapped;
  }
  return surface;
}

#endif
