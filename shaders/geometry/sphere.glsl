// Analytic spheres: where a ray meets one, and the surface there.

#ifndef TANDEM_GEOMETRY_SPHERE
#define TANDEM_GEOMETRY_SPHERE

#include "math.glsl"

/// Where a ray enters and leaves a sphere, in lengths of the direction; -1 twice where it passes by. The discriminant
/// is computed from the ray's closest point to the centre and the roots without a difference of like numbers, after
/// Haines, Günther and Akenine-Möller (Precision Improvements for Ray/Sphere Intersection, Ray Tracing Gems, chapter 7,
/// 2019): far and huge spheres keep their shape.
precise vec2 sphere_roots(vec3 centre, float radius, vec3 origin, vec3 direction) {
  const vec2 missed = vec2(-1.0);
  vec3 from_centre = origin - centre;
  float squared_length = det_dot(direction, direction);
  if (!(squared_length >= SMALLEST_NORMAL)) return missed;
  float b = -det_dot(from_centre, direction);
  vec3 closest = from_centre + direction * det_div(b, squared_length);
  float discriminant = radius * radius - det_dot(closest, closest);
  if (!(discriminant >= 0.0)) return missed;
  float root = det_sqrt(squared_length * discriminant);
  float q = b < 0.0 ? b - root : b + root;
  if (!(abs(q) >= SMALLEST_NORMAL)) return missed;
  float c = det_dot(from_centre, from_centre) - radius * radius;
  float one = det_div(c, q);
  float other = det_div(q, squared_length);
  return b < 0.0 ? vec2(other, one) : vec2(one, other);
}

/// The unit normal, outwards, where a ray that meets the sphere at t is.
precise vec3 sphere_normal(vec3 centre, vec3 origin, vec3 direction, float t) {
  return det_normalize((origin - centre) + direction * t, -direction);
}

/// Texture coordinates at a unit normal: u once around the y axis from -x by +z, v from the lower pole to the upper one.
precise vec2 sphere_texture_coordinates(vec3 normal) {
  return vec2(0.5 + (0.5 * INV_PI) * det_atan2(-normal.z, normal.x), INV_PI * det_acos(-normal.y));
}

/// How the point at a unit normal moves with the first of its texture coordinates.
precise vec3 sphere_derivative_by_u(float radius, vec3 normal) {
  return vec3(normal.z, 0.0, -normal.x) * (2.0 * PI * radius);
}

/// And with the second; 0 at the poles.
precise vec3 sphere_derivative_by_v(float radius, vec3 normal) {
  float around = det_sqrt(normal.x * normal.x + normal.z * normal.z);
  if (!(around > 1e-10)) return vec3(0.0);
  float slope = det_div(-normal.y, around);
  return vec3(normal.x * slope, around, normal.z * slope) * (PI * radius);
}

// A point of a sphere, and the sphere that this arithmetic sees, are off the true one by a few ULP; three in the worst case
// that the tests find.
const uint SPHERE_OFFSET_ULP = 16;

/// How far from the sphere its rays start: offset_distance of geometry/offset_ray.glsl for a surface that no backend
/// computes for itself.
precise float sphere_offset(vec3 centre, float radius, vec3 normal) {
  precise float scale = det_dot(abs(normal), max(abs(centre), vec3(radius)));
  scale = scale > 1e-30 ? scale : 1e-30;
  return uintBitsToFloat(floatBitsToUint(scale) + SPHERE_OFFSET_ULP) - scale;
}

#endif
