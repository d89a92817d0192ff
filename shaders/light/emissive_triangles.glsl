// Points on the emissive triangles, which radiate to both sides.

#ifndef TANDEM_LIGHT_EMISSIVE_TRIANGLES
#define TANDEM_LIGHT_EMISSIVE_TRIANGLES

#include "geometry/opacity.glsl"
#include "geometry/surface.glsl"
#include "random.glsl"
#include "sampling/alias_table.glsl"
#include "sampling/triangle.glsl"

struct LightSample {
  uint triangle;
  vec3 position;
  vec3 normal;         // unit, of either side
  float offset;        // offset_distance of the position
  float area_density;  // of the position, per unit area over all lights
  float opacity;       // at the position: the fraction of its emission that leaves it
};

/// A point on a light; the lights weighted as their alias table says. There is at least one light.
precise LightSample sample_light(uvec4 bits) {
  uint index = uniform_index(bits.x, render.light_count);
  index = alias_choice(index, lights[index].alias, lights[index].threshold, bits.y);

  LightSample light;
  light.triangle = lights[index].triangle;
  light.area_density = lights[index].area_density;
  TriangleVertices triangle = triangle_vertices(triangles[light.triangle].vertices);
  float u = unit_interval(bits.z);
  float v = unit_interval(bits.w);
  vec2 barycentrics = uniform_triangle(vec2(u, v));
  light.position = barycentric_point(triangle, barycentrics);
  light.normal = triangle_normal(triangle, vec3(0.0, 0.0, 1.0));
  light.offset = offset_distance(light.position, light.normal, triangle_extent(triangle));
  light.opacity = opacity_at(light.triangle, barycentrics);
  return light;
}

#endif
