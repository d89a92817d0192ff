// Radiance from all around: a constant, or an equirectangular map whose texels are chosen by an alias table. A direction
// within a texel is uniform over the texel's solid angle.

#ifndef TANDEM_LIGHT_ENVIRONMENT
#define TANDEM_LIGHT_ENVIRONMENT

#include "light/light_sample.glsl"
#include "math.glsl"
#include "random.glsl"
#include "sampling/alias_table.glsl"
#include "scene.glsl"
#include "texture/image.glsl"

/// Columns and rows of the map; a constant is one of a single texel.
uvec2 environment_size() {
  if (render.environment_texture == NO_TEXTURE) return uvec2(1);
  return uvec2(textures[render.environment_texture].width, textures[render.environment_texture].height);
}

/// Where the map shows a direction: its texture coordinates, from the lower left corner, in [0, 1].
precise vec2 environment_coordinates(vec3 direction) {
  float right = det_dot(direction, render.environment_right);
  float up = det_dot(direction, render.environment_up);
  float forward = det_dot(direction, render.environment_forward);
  float across = det_sqrt(right * right + forward * forward);
  return vec2(0.5 + det_atan2(right, forward) * (0.5 * INV_PI), 1.0 - det_atan2(across, up) * INV_PI);
}

precise vec3 environment_radiance_at(vec2 coordinates) {
  if (render.environment_texture == NO_TEXTURE) return render.background;
  // Beyond the centres of the outer rows there is nothing to interpolate with: the poles have the colour of their row.
  float margin = det_div(0.5, float(environment_size().y));
  float v = coordinates.y > margin ? coordinates.y : margin;
  v = v < 1.0 - margin ? v : 1.0 - margin;
  return render.background * textures[render.environment_texture].color_a *
         image_at(render.environment_texture, vec2(coordinates.x, v)).xyz;
}

precise float environment_density_at(vec2 coordinates) {
  if (render.environment_light == NO_LIGHT) return 0.0;
  uvec2 size = environment_size();
  // The texel that image_at takes without a filter, to the last bit: what it finds there has a density.
  precise vec2 place = vec2(coordinates.x < 1.0 ? coordinates.x : 0.0, coordinates.y) * vec2(size);
  uint column = uint(place.x);
  uint row_from_below = uint(place.y);
  column = column < size.x ? column : size.x - 1;
  row_from_below = row_from_below < size.y ? row_from_below : size.y - 1;
  uint cell = (size.y - 1 - row_from_below) * size.x + column;
  return lights[render.environment_light].probability * environment_cells[cell].density;
}

/// Radiance that arrives from far away. `direction` is a unit vector to where it comes from.
precise vec3 environment_radiance(vec3 direction) {
  if (!FEATURE_LIGHTS) return render.background;
  return environment_radiance_at(environment_coordinates(direction));
}

/// Solid-angle density, over all lights, with which sample_light gives a direction that leaves the scene.
precise float environment_density(vec3 direction) {
  if (!FEATURE_LIGHTS) return 0.0;
  return environment_density_at(environment_coordinates(direction));
}

/// The direction at a fraction of the solid angle of a texel. @param u in [0, 1)^2
precise vec3 environment_direction(uvec2 texel, uvec2 size, vec2 u) {
  // The squared sine of half the angle to a pole is proportional to the solid angle from there on. Counting from the
  // nearer pole keeps it exact.
  bool lower = 2 * texel.y >= size.y;
  uint row = lower ? size.y - 1 - texel.y : texel.y;
  float half_row = det_div(HALF_PI, float(size.y));
  float begin = det_sin(float(row) * half_row);
  float end = det_sin(float(row + 1) * half_row);
  float squared_begin = begin * begin;
  float squared_sine = squared_begin + u.y * (end * end - squared_begin);
  squared_sine = squared_sine < 1.0 ? squared_sine : 1.0;
  float up = 1.0 - 2.0 * squared_sine;
  float across = 2.0 * det_sqrt(squared_sine * (1.0 - squared_sine));

  vec2 turn = det_sincos((float(texel.x) + u.x) * det_div(2.0 * PI, float(size.x)) - PI);
  return (render.environment_right * (across * turn.x) + render.environment_up * (lower ? -up : up)) +
         render.environment_forward * (across * turn.y);
}

/// @param bits 32 uniform bits each: for the texel, its alias, and the direction within
precise LightSample sample_environment_light(uvec3 bits) {
  LightSample light = dark_light_sample();
  light.infinite = true;
  uvec2 size = environment_size();
  uint within;
  uint cell = uniform_index(bits.x, size.x * size.y, within);
  cell = alias_choice(cell, environment_cells[cell].alias, environment_cells[cell].threshold, bits.y);
  float u = unit_interval(bits.z);
  float v = unit_interval(within);
  light.direction = environment_direction(uvec2(cell % size.x, cell / size.x), size, vec2(u, v));
  // From the direction, so that a path which finds it by scattering sees the same numbers.
  vec2 coordinates = environment_coordinates(light.direction);
  light.density = environment_density_at(coordinates);
  if (light.density > 0.0) light.radiance = environment_radiance_at(coordinates);
  return light;
}

#endif
