// Where a ray meets a triangle, and the triangle's normal, from its vertices.

#ifndef TANDEM_GEOMETRY_TRIANGLE
#define TANDEM_GEOMETRY_TRIANGLE

#include "math.glsl"

struct TriangleVertices {
  vec3 a;
  vec3 b;
  vec3 c;
};

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

#endif
