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

/// Whether any of these attributes of the vertices counts. @param bits ATTRIBUTE_*
bool has_attribute(uint material, uint bits) {
  return FEATURE_TEXTURES && (materials[material].attributes & bits) != 0;
}

/// Both sets of texture coordinates.
precise vec4 surface_texture_coordinates(uint material, uvec3 vertices, vec2 barycentrics) {
  float weight = (1.0 - barycentrics.x) - barycentrics.y;
  precise vec2 first = (vertex_texture_coordinates(vertices.x) * weight +
                        vertex_texture_coordinates(vertices.y) * barycentrics.x) +
                       vertex_texture_coordinates(vertices.z) * barycentrics.y;
  if (!has_attribute(material, ATTRIBUTE_TEXTURE_COORDINATES)) return vec4(first, vec2(0.0));
  precise vec2 second = (vertex_attributes[vertices.x].texture_coordinates * weight +
                         vertex_attributes[vertices.y].texture_coordinates * barycentrics.x) +
                        vertex_attributes[vertices.z].texture_coordinates * barycentrics.y;
  return vec4(first, second);
}

/// The vertices' factors on the base colour, and on the opacity.
precise vec4 surface_tint(uint material, uvec3 vertices, vec2 barycentrics) {
  vec4 tint = vec4(1.0);
  if (!has_attribute(material, ATTRIBUTE_COLOR | ATTRIBUTE_OPACITY)) return tint;
  float weight = (1.0 - barycentrics.x) - barycentrics.y;
  precise vec4 sum = vec4(0.0);
  for (uint corner = 0; corner < 3; ++corner) {
    uint vertex = vertices[corner];
    float part = corner == 0 ? weight : barycentrics[corner - 1];
    sum += vec4(vertex_attributes[vertex].color, vertex_attributes[vertex].opacity) * part;
  }
  if (has_attribute(material, ATTRIBUTE_COLOR)) tint.xyz = sum.xyz;
  if (has_attribute(material, ATTRIBUTE_OPACITY)) tint.w = sum.w;
  return tint;
}

/// How the texture coordinates of a triangle, those of its normal map, go with its points; or the vertices' tangents.
precise SurfaceDerivatives surface_derivatives(uint material, uvec3 vertices, TriangleVertices triangle,
                                               vec2 barycentrics, vec3 normal) {
  if (has_attribute(material, ATTRIBUTE_TANGENT)) {
    float weight = (1.0 - barycentrics.x) - barycentrics.y;
    precise vec3 tangent = (vertex_attributes[vertices.x].tangent.xyz * weight +
                            vertex_attributes[vertices.y].tangent.xyz * barycentrics.x) +
                           vertex_attributes[vertices.z].tangent.xyz * barycentrics.y;
    SurfaceDerivatives given;
    given.by_u = tangent;
    given.by_v = det_cross(normal, tangent) * vertex_attributes[vertices.x].tangent.w;
    return given;
  }
  uint map = bending_texture(material);
  vec2 corners[3];
  for (uint corner = 0; corner < 3; ++corner) {
    uint vertex = vertices[corner];
    corners[corner] = textures[map].coordinates == 0 ? vertex_texture_coordinates(vertex)
                                                     : vertex_attributes[vertex].texture_coordinates;
  }
  return triangle_derivatives(triangle.b - triangle.a, triangle.c - triangle.a, corners[1] - corners[0],
                              corners[2] - corners[0]);
}

struct Surface {
  vec3 position;
  vec3 geometric_normal;  // unit, on the side from which the ray came
  vec3 shading_normal;    // unit, likewise
  vec3 departure;         // where rays leave from: the position, or above it on the smooth surface that the normals mean
  vec3 side_normal;       // unit: the side that reflected light goes to; the geometric normal, or that of the smooth surface
  float offset;           // offset_distance of the position
  bool outside;           // the ray came from the side of a triangle's own (counter-clockwise) normal, or from out of a sphere
  uint material;
  // With FEATURE_TEXTURES:
  vec4 texture_coordinates;  // both sets
  vec3 tint;                 // factor on the base colour
};

/// Whether the other side matters to rays that leave the surface.
bool lets_through(uint material) {
  uint model = materials[material].model;
  return model == MATERIAL_DIELECTRIC || model == MATERIAL_ROUGH_DIELECTRIC || model == MATERIAL_THIN ||
         model == MATERIAL_BOUNDARY || (model == MATERIAL_PRINCIPLED && materials[material].transmission > 0.0);
}

// Normals that lean farther from their triangle (cosine of 30 degrees) do not mean that it is round.
const float LEAST_ROUND_COSINE = 0.8660254;

/// From a point of a triangle to the smooth surface that its vertices' normals mean: the point is projected onto the
/// plane of each vertex that lies above it, and the projections are interpolated (Hanika, Hacking the Shadow Terminator,
/// Ray Tracing Gems II, chapter 4, 2021). 0 where the surface is hollow or the normals mean none.
/// @param turn -1 where the normals are to be turned round to face `normal`, else 1
precise vec3 smooth_rise(uvec3 vertices, TriangleVertices triangle, vec2 barycentrics, vec3 position, vec3 normal,
                         float turn) {
  vec3 a = vertex_normal(vertices.x) * turn;
  vec3 b = vertex_normal(vertices.y) * turn;
  vec3 c = vertex_normal(vertices.z) * turn;
  precise float cosine_a = det_dot(a, normal);
  precise float cosine_b = det_dot(b, normal);
  precise float cosine_c = det_dot(c, normal);
  if (!(cosine_a > LEAST_ROUND_COSINE && cosine_b > LEAST_ROUND_COSINE && cosine_c > LEAST_ROUND_COSINE))
    return vec3(0.0);
  precise float below_a = det_dot(triangle.a - position, a);
  precise float below_b = det_dot(triangle.b - position, b);
  precise float below_c = det_dot(triangle.c - position, c);
  float rise_a = below_a > 0.0 ? below_a * ((1.0 - barycentrics.x) - barycentrics.y) : 0.0;
  float rise_b = below_b > 0.0 ? below_b * barycentrics.x : 0.0;
  float rise_c = below_c > 0.0 ? below_c * barycentrics.y : 0.0;
  return (a * rise_a + b * rise_b) + c * rise_c;
}

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
  surface.side_normal = surface.geometric_normal;
  surface.departure = surface.position;
  surface.offset = sphere_offset(centre, radius, normal);
  surface.texture_coordinates = FEATURE_TEXTURES ? both_sets(sphere_texture_coordinates(normal)) : vec4(0.0);
  surface.tint = vec3(1.0);
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
  surface.side_normal = surface.geometric_normal;
  surface.departure = surface.position;
  surface.offset = offset_distance(surface.position, normal, triangle_extent(triangle));

  surface.texture_coordinates =
      FEATURE_TEXTURES ? surface_texture_coordinates(surface.material, vertices, barycentrics) : vec4(0.0);
  surface.tint = FEATURE_TEXTURES ? surface_tint(surface.material, vertices, barycentrics).xyz : vec3(1.0);

  if ((material & TRIANGLE_SMOOTH) != 0) {
    precise vec3 interpolated = (vertex_normal(vertices.x) * ((1.0 - barycentrics.x) - barycentrics.y) +
                                 vertex_normal(vertices.y) * barycentrics.x) +
                                vertex_normal(vertices.z) * barycentrics.y;
    precise vec3 smooth_normal = det_normalize(interpolated, surface.geometric_normal);
    bool turned = det_dot(smooth_normal, surface.geometric_normal) < 0.0;
    if (turned) smooth_normal = -smooth_normal;
    // Seen from behind an interpolated normal means nothing: near silhouettes the geometric one takes over.
    if (det_dot(smooth_normal, direction) < 0.0) {
      surface.shading_normal = smooth_normal;
      if (FEATURE_OPTIONS && render.terminator_offset != 0 && !lets_through(surface.material)) {
        vec3 rise = smooth_rise(vertices, triangle, barycentrics, surface.position, surface.geometric_normal,
                                turned ? -1.0 : 1.0);
        // Well above what offset_point takes back for directions below the triangle's plane.
        precise float height = det_dot(rise, surface.geometric_normal);
        precise float safe_height = 4.0 * surface.offset;
        if (height > safe_height) {
          surface.departure = surface.position + rise;
          surface.side_normal = smooth_normal;
        }
      }
    }
  }
  derivatives.by_u = vec3(0.0);
  derivatives.by_v = vec3(0.0);
  if (has_normal_map(surface.material)) {
    precise vec3 front = surface.outside ? surface.shading_normal : -surface.shading_normal;
    derivatives = surface_derivatives(surface.material, vertices, triangle, barycentrics, front);
  }
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
