// The ray of a camera: the still pinhole, and with FEATURE_CAMERAS all others.

#ifndef TANDEM_CAMERA_CAMERA
#define TANDEM_CAMERA_CAMERA

#include "camera/equirectangular.glsl"
#include "camera/film.glsl"
#include "camera/orthographic.glsl"
#include "camera/pinhole.glsl"
#include "camera/shutter.glsl"
#include "camera/thin_lens.glsl"
#include "sampling/sampler.glsl"
#include "scene.glsl"

struct CameraRay {
  vec3 origin;
  vec3 direction;  // unit
};

/// Of a path through a pixel. @param time shutter_time(key)
precise CameraRay camera_ray(uvec2 pixel, RandomKey key, float time) {
  uvec4 bits = sampler_bits(key, DIMENSION_CAMERA);
  float film_x = unit_interval(bits.x);
  float film_y = unit_interval(bits.y);
  vec2 film = film_point(pixel, vec2(film_x, film_y), render.resolution);
  CameraRay ray;
  ray.origin = render.camera_position;
  if (!FEATURE_CAMERAS || (render.camera_kind == CAMERA_PERSPECTIVE && render.lens_radius == 0.0)) {
    ray.direction = pinhole_direction(film, render.camera_right, render.camera_up, render.camera_forward);
  } else if (render.camera_kind == CAMERA_PERSPECTIVE) {
    float lens_x = unit_interval(bits.z);
    float lens_y = unit_interval(bits.w);
    vec3 from = lens_point(vec2(lens_x, lens_y), render.lens_radius, render.camera_right, render.camera_up);
    ray.origin += from;
    ray.direction = lens_direction(film, from, render.focus_distance, render.camera_right, render.camera_up,
                                   render.camera_forward);
  } else if (render.camera_kind == CAMERA_ORTHOGRAPHIC) {
    ray.origin += orthographic_point(film, render.camera_right, render.camera_up);
    ray.direction = render.camera_forward;
  } else {
    ray.direction = equirectangular_direction(film, render.camera_right, render.camera_up, render.camera_forward);
  }
  if (FEATURE_CAMERAS && time > 0.0) ray.origin += render.camera_motion * time;
  return ray;
}

#endif
