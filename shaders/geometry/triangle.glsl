// The surface at a hit. The device only says which triangle a ray meets; where, and with which normals, is computed
// here from the vertices, the same way on every device.

#ifndef TANDEM_GEOMETRY_TRIANGLE
#define TANDEM_GEOMETRY_TRIANGLE

#include "geometry/offset_ray.glsl"
#include "math.glsl"
#include "scene.glsl"

struct TriangleVertices {
  vec3 a;
  vec3 b;
  vec3 c;
};

vec3 vertex_position(uint vertex) {
  return vec3(positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]);
}

vec3 vertex_normal(uint vertex) {
  return vec3(normals[3 * vertex], normals[3 * vertex + 1], normals[3 * vertex + 2]);
}

TriangleVertices triangle_vertices(uvec3 vertices) {
  return TriangleVertices(vertex_position(vertices.x), vertex_position(vertices.y), vertex_position(vertices.z));
}

/// x in [0, 1]; NaN gives 0.
float clamp_unit(float x) { return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0; }

/// The barycentric coordinates of the second and third vertex where a ray meets the plane of a triangle (Möller and
/// Trumbore 1997), moved into the triangle where rounding put them outside. The centre for a ray in the plane and for a
/// degenerate triangle.
precise vec2 hit_barycentrics(TriangleVertices triangle, vec3 origin, vec3 direction) {
  vec3 edge_b = triangle.b - triangle.a;
  vec3 edge_c = triangle.c - triangle.a;
  vec3 p = det_cross(direction, edge_c);
  precise float determinant = det_dot(edge_b, p);
  if (!(abs(determinant) >= SMALLEST_NORMAL)) return vec2(1.0 / 3.0);
  vec3 s = origin - triangle.a;
  float b = clamp_unit(det_div(det_dot(s, p), determinant));
  float c = clamp_unit(det_div(det_dot(direction, det_cross(s, edge_b)), determinant));
  precise float sum = b + c;
  if (sum > 1.0) {
    b = det_div(b, sum);
    c = 1.0 - b;
  }
  return vec2(b, c);
}

precise vec3 barycentric_point(TriangleVertices triangle, vec2 barycentrics) {
  return triangle.a + ((triangle.b - triangle.a) * barycentrics.x + (triangle.c - triangle.a) * barycentrics.y);
}

/// The unit normal of the side from which the vertices are seen counter-clockwise; `fallback` for a degenerate
/// triangle.
precise vec3 triangle_normal(TriangleVertices triangle, vec3 fallback) {
  return det_normalize(det_cross(triangle.b - triangle.a, triangle.c - triangle.a), fallback);
}

/// The largest |x|, |y| and |z| of the vertices.
vec3 triangle_extent(TriangleVertices triangle) {
  return max(max(abs(triangle.a), abs(triangle.b)), abs(triangle.c));
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
