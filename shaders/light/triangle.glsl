// Emissive triangles as lights: a uniform point on the triangle.

#ifndef TANDEM_LIGHT_TRIANGLE
#define TANDEM_LIGHT_TRIANGLE

#include "geometry/opacity.glsl"
#include "geometry/surface.glsl"
#include "light/emission.glsl"
#include "light/light_sample.glsl"
#include "sampling/triangle.glsl"

/// @param index into lights @param u in [0, 1)^2
precise LightSample sample_triangle_light(uint index, vec3 position, vec2 u) {
  LightSample light = dark_light_sample();
  light.primitive = lights[index].primitive;
  uvec3 vertices = triangles[light.primitive].vertices;
  TriangleVertices triangle = triangle_vertices(vertices);
  vec2 barycentrics = uniform_triangle(u);
  light.target = barycentric_point(triangle, barycentrics);
  light.target_normal = triangle_normal(triangle, vec3(0.0, 0.0, 1.0));
  light.target_offset = offset_distance(light.target, light.target_normal, triangle_extent(triangle));

  precise vec3 to_light = light.target - position;
  precise float squared_distance = det_dot(to_light, to_light);
  // A light that touches the point: there is no direction to it.
  if (!(squared_distance > 1e-30)) return light;
  light.direction = to_light * det_div(1.0, det_sqrt(squared_distance));
  light.density =
      solid_angle_density(lights[index].area_density, position, light.direction, light.target, light.target_normal);
  if (light.density == 0.0) return light;
  uint material = triangles[light.primitive].material & ~TRIANGLE_SMOOTH;
  vec4 uv = FEATURE_TEXTURES ? surface_texture_coordinates(material, vertices, barycentrics) : vec4(0.0);
  vec3 tint = FEATURE_TEXTURES ? surface_tint(material, vertices, barycentrics).xyz : vec3(1.0);
  light.radiance = emitted_radiance(material, uv, light.target, tint) * opacity_at(light.primitive, barycentrics);
  return light;
}

#endif
