// The surface at a hit. The device only says which primitive a ray meets; where, and with which normals, is computed from
// the vertices or the sphere, the same way on every device.

#ifndef TANDEM_GEOMETRY_SURFACE
#define TANDEM_GEOMETRY_SURFACE

#include "geometry/normal_map.glsl"
#include "geometry/offset_ray.glsl"
#include "geometry/sphere_hit.glsl"
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
  bool outside;           // the ray came from the side of a triangle's own (counter-clockwise) normal, or from out of a sphere
  uint material;
  vec2 texture_coordinates;  // with FEATURE_TEXTURES
};

/// surface_at for a sphere, without its normal map.
precise Surface sphere_surface(uint sphere_index, vec3 origin, vec3 direction, float time,
                               out SurfaceDerivatives derivatives) {
  vec3 centre = sphere_centre(sphere_index, time);
  float radius = spheres[sphere_index].radius;
  float t = sphere_hit(sphere_index, origin, direction, time);
  // The ray was traced with a direction of another length, and touches the sphere: rounding decided.
  if (t < 0.0) t = det_dot(centre - origin, direction);
  precise vec3 normal = sphere_normal(centre, origin, direction, t);
  Surface surface;
  surface.material = spheres[sphere_index].material;
  surface.position = centre + normal * radius;
  surface.outside = det_dot(normal, direction) <= 0.0;
  surface.geometric_normal = surface.outside ? normal : -normal;
  surface.shading_normal = surface.geometric_normal;
  surface.offset = sphere_offset(centre, radius, normal);
  surface.texture_coordinates = FEATURE_TEXTURES ? sphere_texture_coordinates(normal) : vec2(0.0);
  derivatives.by_u = sphere_derivative_by_u(radius, normal);
  derivatives.by_v = sphere_derivative_by_v(radius, normal);
  return surface;
}

/// surface_at for a triangle, without its normal map.
precise Surface triangle_surface(uint primitive, vec3 origin, vec3 direction, out SurfaceDerivatives derivatives) {
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
  derivatives.by_u = vec3(0.0);
  derivatives.by_v = vec3(0.0);
  if (has_normal_map(surface.material)) derivatives = surface_derivatives(vertices, triangle);
  return surface;
}

/// The surface where a ray meets a primitive. `direction` has unit length; `time` in [0, 1] since the shutter opened.
precise Surface surface_at(uint primitive, vec3 origin, vec3 direction, float time) {
  Surface surface;
  SurfaceDerivatives derivatives;
  if (FEATURE_SPHERES && primitive >= render.triangle_count) {
    surface = sphere_surface(primitive - render.triangle_count, origin, direction, time, derivatives);
  } else {
    surface = triangle_surface(primitive, origin, direction, derivatives);
  }
  if (has_normal_map(surface.material)) {
    precise vec3 front = surface.outside ? surface.shading_normal : -surface.shading_normal;
    precise vec3 mapped = mapped_normal(surface.material, front, derivatives, surface.texture_coordinates,
                                        surface.position);
    if (!surface.outside) mapped = -mapped;
    // Seen from behind, or turned into the surface, it means as little as an interpolated one.
    bool meaningful = det_dot(mapped, direction) < 0.0 && det_dot(mapped, surface.geometric_normal) > 0.0;
    if (meaningful) surface.shading_normal = mapped;
  }
  return surface;
}

#endif
