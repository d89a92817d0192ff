// How the rays of a trial are asked, and what they may meet: compare/probe/trial.hpp says the same on the host.

#ifndef TANDEM_PROBE_TRIAL
#define TANDEM_PROBE_TRIAL

#include "geometry/sphere.glsl"
#include "random.glsl"

struct ProbeRay {
  vec3 origin;
  float t_min;
  vec3 direction;
  float t_max;
};

layout(set = 0, binding = 0) uniform accelerationStructureEXT probe_scene;
layout(set = 0, binding = 1, std430) readonly buffer Rays { ProbeRay rays[]; };
layout(set = 0, binding = 2, std430) readonly buffer Spheres { vec4 spheres[]; };  // centre and radius, object space

layout(push_constant) uniform Trial {
  uint flags;       // of rays
  uint mask;        // likewise
  uint acceptance;  // a candidate that is not opaque counts if its hash is at most this
  uint ray_count;
} trial;

/// The answer depends on the candidate alone, not on the order in which a device offers them.
bool is_accepted(uint geometry, uint primitive) {
  return pcg4d(uvec4(geometry, primitive, 0u, 0u)).x <= trial.acceptance;
}

/// Where behind t_min a ray in object space first meets a sphere; -1 where it does not. Even spheres are the primitives of
/// geometry 0, odd ones those of geometry 1.
precise float probe_sphere_hit(uint geometry, uint primitive, vec3 origin, vec3 direction, float t_min) {
  vec4 sphere = spheres[2 * primitive + geometry];
  vec2 roots = sphere_roots(sphere.xyz, sphere.w, origin, direction);
  float first = roots.x > t_min ? roots.x : roots.y;
  return first > t_min ? first : -1.0;
}

#endif
