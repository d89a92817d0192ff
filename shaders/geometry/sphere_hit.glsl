// Which of its two sides of a sphere a ray meets, if any. Intersection tests ask this, and so does whoever wants to know
// the surface there: the answer depends on the ray and the sphere alone.

#ifndef TANDEM_GEOMETRY_SPHERE_HIT
#define TANDEM_GEOMETRY_SPHERE_HIT

#include "geometry/material_opacity.glsl"
#include "geometry/sphere.glsl"
#include "random.glsl"
#include "scene.glsl"

// Nearer than this nothing is met: it exceeds every t_min (trace/ray_time.glsl), and is far below any offset.
const float NEAREST_SPHERE_HIT = 1.57772181e-30;  // 2^-99

/// The centre at a time in [0, 1] since the shutter opened.
precise vec3 sphere_centre(uint sphere_index, float time) {
  return spheres[sphere_index].centre + spheres[sphere_index].motion * time;
}

/// Whether a ray meets one side (0: where it enters, 1: where it leaves) at t. The random number that this takes is a
/// hash of the ray itself, because an intersection shader knows nothing else.
bool meets_side(uint sphere_index, uint side, vec3 centre, vec3 origin, vec3 direction, float t) {
  uint material = spheres[sphere_index].material;
  if (materials[material].opacity >= 1.0 && materials[material].alpha_texture == NO_TEXTURE) return true;
  precise vec3 normal = sphere_normal(centre, origin, direction, t);
  precise vec3 position = centre + normal * spheres[sphere_index].radius;
  precise float opacity = material_opacity(material, both_sets(sphere_texture_coordinates(normal)), position, 1.0);
  uvec4 bits = pcg4d(uvec4(floatBitsToUint(direction), 2 * sphere_index + side));
  bits = pcg4d(bits ^ uvec4(floatBitsToUint(origin), 0u));
  return unit_interval(bits.x) < opacity;
}

/// The t, in lengths of the direction, at which a ray first meets a sphere; -1 where it does not.
precise float sphere_hit(uint sphere_index, vec3 origin, vec3 direction, float time) {
  vec3 centre = sphere_centre(sphere_index, time);
  vec2 roots = sphere_roots(centre, spheres[sphere_index].radius, origin, direction);
  if (!FEATURE_TRANSPARENCY) {
    float first = roots.x > NEAREST_SPHERE_HIT ? roots.x : roots.y;
    return first > NEAREST_SPHERE_HIT ? first : -1.0;
  }
  for (uint side = 0; side < 2; ++side) {
    float t = side == 0 ? roots.x : roots.y;
    if (t > NEAREST_SPHERE_HIT && meets_side(sphere_index, side, centre, origin, direction, t)) return t;
  }
  return -1.0;
}

#endif
