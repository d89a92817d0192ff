// What next event estimation gets of a light.

#ifndef TANDEM_LIGHT_LIGHT_SAMPLE
#define TANDEM_LIGHT_LIGHT_SAMPLE

#include "trace/primitive_index.glsl"

struct LightSample {
  vec3 direction;    // unit, from the point that is lit towards the light
  vec3 radiance;     // that arrives along it where nothing is in between; 0: this light does not shine here
  float density;     // of the direction per solid angle, times that of the choice; 0: a light without extent, whose
                     // radiance is already divided by the density of the choice
  uint primitive;    // the triangle that is the light, which cannot light itself; NO_PRIMITIVE for lights of other kinds
  bool infinite;     // the light is not at any point
  vec3 target;       // else the point on it, where a shadow ray ends
  vec3 target_normal;  // unit, of either side of its surface; 0 without one
  float target_offset;  // offset_distance there
};

/// Of a light that does not shine here.
precise LightSample dark_light_sample() {
  LightSample light;
  light.direction = vec3(0.0, 0.0, 1.0);
  light.radiance = vec3(0.0);
  light.density = 0.0;
  light.primitive = NO_PRIMITIVE;
  light.infinite = false;
  light.target = vec3(0.0);
  light.target_normal = vec3(0.0);
  light.target_offset = 0.0;
  return light;
}

#endif
