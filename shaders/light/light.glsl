// Lights: one of them chosen, and a direction towards it. Every light is an entry of the alias table.

#ifndef TANDEM_LIGHT_LIGHT
#define TANDEM_LIGHT_LIGHT

#include "light/emission.glsl"
#include "light/environment.glsl"
#include "light/light_sample.glsl"
#include "light/punctual.glsl"
#include "light/sphere.glsl"
#include "light/triangle.glsl"
#include "random.glsl"
#include "sampling/alias_table.glsl"

/// Solid-angle density, over all lights, with which sample_light gives the direction from `position` to a point of a
/// primitive; 0 for one that is no light. Its counterpart for what lies behind the scene is environment_density.
/// @param direction unit, from the position to the point @param normal unit, there, of either side
/// @param time in [0, 1] since the shutter opened
precise float light_density(uint primitive, vec3 position, vec3 direction, vec3 point, vec3 normal, float time) {
  uint index = primitive_lights[primitive];
  if (index == NO_LIGHT) return 0.0;
  if (FEATURE_LIGHTS && lights[index].kind == LIGHT_SPHERE)
    return sphere_light_density(index, position, direction, point, normal, time);
  return solid_angle_density(lights[index].area_density, position, direction, point, normal);
}

/// A direction from `position` towards a light; the lights weighted as their alias table says. There is at least one.
/// @param time in [0, 1] since the shutter opened
precise LightSample sample_light(vec3 position, uvec4 bits, float time) {
  uint rest;
  uint index = uniform_index(bits.x, render.light_count, rest);
  index = alias_choice(index, lights[index].alias, lights[index].threshold, bits.y);
  uint kind = FEATURE_LIGHTS ? lights[index].kind : LIGHT_TRIANGLE;
  if (kind == LIGHT_ENVIRONMENT) return sample_environment_light(uvec3(bits.z, rest, bits.w));
  if (kind != LIGHT_TRIANGLE && kind != LIGHT_SPHERE) return sample_punctual_light(index, position);
  float u = unit_interval(bits.z);
  float v = unit_interval(bits.w);
  if (kind == LIGHT_SPHERE) return sample_sphere_light(index, position, vec2(u, v), time);
  return sample_triangle_light(index, position, vec2(u, v));
}

#endif
