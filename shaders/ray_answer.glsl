// What an invocation does that traces one ray again, as it was traced, and stores the answer. Of the dispatch constants,
// tile_size.x is the number of rays.

#ifndef TANDEM_RAY_ANSWER
#define TANDEM_RAY_ANSWER

#include "scene.glsl"
#include "trace.glsl"
#include "trace/traced_ray.glsl"

layout(set = 1, binding = 2, std430) buffer RayLog { TracedRay ray_log[]; };

void ray_answer(uint index) {
  if (index >= dispatch.tile_size.x) return;
  TracedRay ray = ray_log[index];
  RandomKey key;
  key.pixel = ray.pixel;
  key.sample_index = ray.sample_index;
  key.seed = render.seed;
  uint answer;
  if (ray.kind == RAY_CLOSEST) {
    answer = closest_primitive(ray.origin, ray.direction, ray.t_max, key, ray.dimension);
  } else {
    answer = is_occluded(ray.origin, ray.direction, ray.t_max, key, ray.dimension) ? 1u : 0u;
  }
  ray_log[index].answer = answer;
}

#endif
