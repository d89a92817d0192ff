// Emissive spheres as lights: from outside a uniform direction of the cone that the sphere fills (Wang 1992), from inside
// a uniform point of its surface. So too where rays may pass the near side of the sphere and meet the far one.

#ifndef TANDEM_LIGHT_SPHERE
#define TANDEM_LIGHT_SPHERE

#include "geometry/frame.glsl"
#include "geometry/material_opacity.glsl"
#include "geometry/sphere.glsl"
#include "geometry/sphere_hit.glsl"
#include "light/emission.glsl"
#include "light/light_sample.glsl"
#include "math.glsl"
#include "scene.glsl"

/// Whether a point sees the sphere as a cone. So close to it that rounding cannot tell which side the point is on, any
/// point of the surface is a candidate. @param squared_distance from its centre
bool is_cone(uint sphere, float squared_distance) {
  uint material = spheres[sphere].material;
  if (FEATURE_TRANSPARENCY && (materials[material].opacity < 1.0 || materials[material].alpha_texture != NO_TEXTURE))
    return false;
  float radius = spheres[sphere].radius;
  precise float limit = 1.0001 * (radius * radius);
  return squared_distance > limit;
}

/// 1 minus the cosine of half the angle of the cone.
precise float cone_height(float squared_distance, float radius) {
  float squared_sine = det_div(radius * radius, squared_distance);
  return det_div(squared_sine, 1.0 + det_sqrt(1.0 - squared_sine));
}

/// Of a direction in it, times that of choosing the light. @param index into lights
precise float cone_density(uint index, float height) {
  return det_div(lights[index].probability * (0.5 * INV_PI), height);
}

/// light_density of a sphere. @param index into lights
precise float sphere_light_density(uint index, vec3 position, vec3 direction, vec3 point, vec3 normal, float time) {
  uint sphere = lights[index].primitive - render.triangle_count;
  vec3 to_centre = sphere_centre(sphere, time) - position;
  precise float squared_distance = det_dot(to_centre, to_centre);
  if (is_cone(sphere, squared_distance))
    return cone_density(index, cone_height(squared_distance, spheres[sphere].radius));
  return solid_angle_density(lights[index].area_density, position, direction, point, normal);
}

/// @param index into lights @param u in [0, 1)^2
precise LightSample sample_sphere_light(uint index, vec3 position, vec2 u, float time) {
  LightSample light = dark_light_sample();
  uint sphere = lights[index].primitive - render.triangle_count;
  float radius = spheres[sphere].radius;
  vec3 centre = sphere_centre(sphere, time);
  precise vec3 to_centre = centre - position;
  precise float squared_distance = det_dot(to_centre, to_centre);
  bool cone = is_cone(sphere, squared_distance);
  // Either is uniform over the part of a sphere of directions that lies within a height from its pole.
  float height = cone ? cone_height(squared_distance, radius) : 2.0;
  vec2 turn = det_sincos(2.0 * PI * u.x);
  precise float below = u.y * height;
  precise float squared_sine = below * (2.0 - below);
  float sine = det_sqrt(squared_sine);
  vec3 pole = det_normalize(to_centre, vec3(0.0, 0.0, 1.0));
  precise vec3 uniform_direction = to_world(make_frame(pole), vec3(sine * turn.y, sine * turn.x, 1.0 - below));

  light.target_normal = uniform_direction;
  if (cone) {
    // The nearer of the points where the direction meets the sphere.
    light.direction = uniform_direction;
    precise float squared_half_chord = radius * radius - squared_distance * squared_sine;
    float half_chord = squared_half_chord > 0.0 ? det_sqrt(squared_half_chord) : 0.0;
    precise float distance = det_sqrt(squared_distance) * (1.0 - below) - half_chord;
    light.target_normal = det_normalize(uniform_direction * distance - to_centre, -uniform_direction);
  }
  light.target = centre + light.target_normal * radius;
  light.target_offset = sphere_offset(centre, radius, light.target_normal);
  if (!cone) {
    precise vec3 to_light = light.target - position;
    if (!(det_dot(to_light, to_light) > 1e-30)) return light;
    light.direction = det_normalize(to_light, vec3(0.0, 0.0, 1.0));
  }
  light.density = cone ? cone_density(index, height)
                       : solid_angle_density(lights[index].area_density, position, light.direction, light.target,
                                             light.target_normal);
  if (light.density == 0.0) return light;
  uint material = spheres[sphere].material;
  vec4 uv = FEATURE_TEXTURES ? both_sets(sphere_texture_coordinates(light.target_normal)) : vec4(0.0);
  light.radiance = emitted_radiance(material, uv, light.target, vec3(1.0));
  if (FEATURE_TRANSPARENCY) light.radiance *= material_opacity(material, uv, light.target, 1.0);
  return light;
}

#endif
