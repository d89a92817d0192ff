// When, while the shutter is open, a path looks at the scene.

#ifndef TANDEM_CAMERA_SHUTTER
#define TANDEM_CAMERA_SHUTTER

#include "sampling/sampler.glsl"
#include "scene.glsl"

/// The time of all rays of a path, in [0, 1) of the time that the shutter is open; 0 where nothing moves.
precise float shutter_time(RandomKey key) {
  if (!FEATURE_SPHERES && !FEATURE_CAMERAS) return 0.0;
  if (render.shutter == 0.0) return 0.0;
  return unit_interval(sampler_bits(key, DIMENSION_TIME).x);
}

#endif
