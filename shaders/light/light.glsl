// Lights: one of them chosen, and a direction towards it. Every light is an entry of the alias table.

#ifndef TANDEM_LIGHT_LIGHT
#define TANDEM_LIGHT_LIGHT

#include "geometry/opacity.glsl"
#include "geometry/surface.glsl"
#include "random.glsl"
#include "sampling/alias_table.glsl"
#include "sampling/triangle.glsl"

struct LightSample {
  vec3 direction;    // unit, from the point that is lit towards the light
  vec3 radiance;     // that arrives along it where nothing is in between; 0: this light does not shine here
  float density;     // of the direction per solid angle, times that of the choice; 0: a light without extent, whose
                     // radiance is already divided by the density of the choice
  uint primitive;    // that is the light, or NO_PRIMITIVE
  bool infinite;     // the light is not at any point
  vec3 target;       // else the point on it, where a shadow ray ends
  vec3 target_normal;  // unit, of either side of its surface; 0 without one
  float target_offset;  // offset_distance there
};

/// Solid-angle density, over all lights, with which sample_light gives the direction from `position` to a point on a
/// triangle that is a light. @param light index into lights @param normal unit, of either side
precise float light_density(uint light, vec3 position, vec3 point, vec3 normal) {
  vec3 to_light = point - position;
  precise float squared_distance = det_dot(to_light, to_light);
  precise float cosine = abs(det_dot(to_light, normal));  // times the distance
  if (!(cosine > 0.0)) return 0.0;
  return det_div(lights[light].area_density * squared_distance * det_sqrt(squared_distance), cosine);
}

/// A direction from `position` towards a light; the lights weighted as their alias table says. There is at least one.
precise LightSample sample_light(vec3 position, uvec4 bits) {
  uint index = uniform_index(bits.x, render.light_count);
  index = alias_choice(index, lights[index].alias, lights[index].threshold, bits.y);

  LightSample light;
  light.direction = vec3(0.0, 0.0, 1.0);
  light.radiance = vec3(0.0);
  light.density = 0.0;
  light.primitive = lights[index].primitive;
  light.infinite = false;
  TriangleVertices triangle = triangle_vertices(triangles[light.primitive].vertices);
  float u = unit_interval(bits.z);
  float v = unit_interval(bits.w);
  vec2 barycentrics = uniform_triangle(vec2(u, v));
  light.target = barycentric_point(triangle, barycentrics);
  light.target_normal = triangle_normal(triangle, vec3(0.0, 0.0, 1.0));
  light.target_offset = offset_distance(light.target, light.target_normal, triangle_extent(triangle));

  precise vec3 to_light = light.target - position;
  precise float squared_distance = det_dot(to_light, to_light);
  // A light that touches the point: there is no direction to it.
  if (!(squared_distance > 1e-30)) return light;
  light.direction = to_light * det_div(1.0, det_sqrt(squared_distance));
  precise float cosine = abs(det_dot(light.direction, light.target_normal));
  if (!(cosine > 0.0)) return light;
  light.density = det_div(lights[index].area_density * squared_distance, cosine);
  uint material = triangles[light.primitive].material & ~TRIANGLE_SMOOTH;
  light.radiance = materials[material].emission * opacity_at(light.primitive, barycentrics);
  return light;
}

#endif
