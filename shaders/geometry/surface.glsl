// The surface at a hit. The device only says which triangle a ray meets; where, and with which normals, is computed from
// the vertices, the same way on every device.

#ifndef TANDEM_GEOMETRY_SURFACE
#define TANDEM_GEOMETRY_SURFACE

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

struct Surface {
  vec3 position;
  vec3 geometric_normal;  // unit, on the side from which the ray came
  vec3 shading_normal;    // unit, likewise
  float offset;           // offset_distance of the position
  bool outside;           // the ray came from the side of the triangle's own (counter-clockwise) normal
  uint material;
};

/// The surface where a ray meets a triangle. `direction` has unit length.
precise Surface surface_at(uint triangle_index, vec3 origin, vec3 direction) {
  uvec3 vertices = triangles[triangle_index].vertices;
  uint material = triangles[triangle_index].material;
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

  if ((material & TRIANGLE_SMOOTH) != 0) {
    precise vec3 interpolated = (vertex_normal(vertices.x) * ((1.0 - barycentrics.x) - barycentrics.y) +
                                 vertex_normal(vertices.y) * barycentrics.x) +
                                vertex_normal(vertices.z) * barycentrics.y;
    precise vec3 smooth_normal = det_normalize(interpolated, surface.geometric_normal);
    if (det_dot(smooth_normal, surface.geometric_normal) < 0.0) smooth_normal = -smooth_normal;
    // Seen from behind an interpolated normal means nothing: near silhouettes the geometric one takes over.
    if (det_dot(smooth_normal, direction) < 0.0) surface.shading_normal = smooth_normal;
  }
  return surface;
}

#endif
