// Path tracing: one invocation adds a range of samples of one pixel to the sums.
#version 460
#extension GL_EXT_ray_query : require
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

#include "path.glsl"
#include "scene.glsl"

void main() {
  if (any(greaterThanEqual(gl_GlobalInvocationID.xy, render.tile_size))) return;
  uvec2 pixel = render.tile_offset + gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, render.resolution))) return;
  uint index = pixel.y * render.resolution.x + pixel.x;

  // One addition for each sample, in order, so that it does not matter how samples are split over dispatches.
  precise vec3 sum = vec3(radiance_sum[3 * index], radiance_sum[3 * index + 1], radiance_sum[3 * index + 2]);
  uint ray_count = 0;
  for (uint i = 0; i < render.sample_count; ++i) {
    sum += path_radiance(pixel, render.first_sample + i, ray_count);
  }
  radiance_sum[3 * index] = sum.x;
  radiance_sum[3 * index + 1] = sum.y;
  radiance_sum[3 * index + 2] = sum.z;
  ray_counts[index] += ray_count;
}
