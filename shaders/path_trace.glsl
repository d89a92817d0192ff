// What an invocation of the path tracer does: it adds a range of samples of one pixel to the sums.

#ifndef TANDEM_PATH_TRACE
#define TANDEM_PATH_TRACE

#include "integrator/path.glsl"
#include "scene.glsl"

/// `position` is that of the invocation in the tile; beyond the tile or the picture there is nothing to do.
void path_trace(uvec2 position) {
  if (any(greaterThanEqual(position, dispatch.tile_size))) return;
  uvec2 pixel = dispatch.tile_offset + position;
  if (any(greaterThanEqual(pixel, render.resolution))) return;
  uint index = pixel.y * render.resolution.x + pixel.x;

  // One addition for each sample, in order, so that it does not matter how samples are split over dispatches.
  precise vec3 sum = vec3(radiance_sum[3 * index], radiance_sum[3 * index + 1], radiance_sum[3 * index + 2]);
  uint ray_count = 0;
  for (uint i = 0; i < dispatch.sample_count; ++i) {
    sum += path_radiance(pixel, dispatch.first_sample + i, ray_count);
  }
  radiance_sum[3 * index] = sum.x;
  radiance_sum[3 * index + 1] = sum.y;
  radiance_sum[3 * index + 2] = sum.z;
  ray_counts[index] += ray_count;
}

#endif
