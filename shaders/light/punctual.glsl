// Lights without extent: point, spot and directional. Only next event estimation finds them.

#ifndef TANDEM_LIGHT_PUNCTUAL
#define TANDEM_LIGHT_PUNCTUAL

#include "light/light_sample.glsl"
#include "math.glsl"
#include "scene.glsl"

/// The fraction of its intensity that a spot light sends into a direction with that cosine to its own: the square of
/// a ramp in the cosine, as glTF's KHR_lights_punctual has it.
precise float spot_falloff(float cosine, float cosine_inner, float cosine_outer) {
  if (cosine >= cosine_inner) return 1.0;
  if (!(cosine > cosine_outer)) return 0.0;
  precise float ramp = det_div(cosine - cosine_outer, cosine_inner - cosine_outer);
  return ramp * ramp;
}

/// @param index into lights, of one of these kinds
precise LightSample sample_punctual_light(uint index, vec3 position) {
  LightSample light = dark_light_sample();
  uint kind = lights[index].kind;
  vec3 intensity = lights[index].radiance * det_div(1.0, lights[index].probability);
  if (kind == LIGHT_DIRECTIONAL) {
    light.infinite = true;
    light.direction = -lights[index].direction;
    light.radiance = intensity;
    return light;
  }
  light.target = lights[index].position;
  precise vec3 to_light = light.target - position;
  precise float squared_distance = det_dot(to_light, to_light);
  if (!(squared_distance > 1e-30)) return light;
  light.direction = to_light * det_div(1.0, det_sqrt(squared_distance));
  precise float fraction = det_div(1.0, squared_distance);
  if (kind == LIGHT_SPOT)
    fraction *= spot_falloff(-det_dot(light.direction, lights[index].direction), lights[index].cosine_inner,
                             lights[index].cosine_outer);
  light.radiance = intensity * fraction;
  return light;
}

#endif
