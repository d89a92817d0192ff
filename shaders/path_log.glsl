// What an invocation does that writes down the rays of one path. Of the dispatch constants, tile_size.x is the number of
// paths, and sample_count the number of rays that the log has room for of each.

#ifndef TANDEM_PATH_LOG
#define TANDEM_PATH_LOG

#define TANDEM_RAY_LOG
#include "integrator/path.glsl"
#include "scene.glsl"

struct PathId {
  uvec2 pixel;
  uint sample_index;
  uint ray_count;  // written: of the path
};

layout(set = 1, binding = 3, std430) buffer PathIds { PathId path_ids[]; };

void path_log(uint index) {
  if (index >= dispatch.tile_size.x) return;
  ray_log_end = index * dispatch.sample_count;
  uint ray_count = 0;
  path_radiance(path_ids[index].pixel, path_ids[index].sample_index, ray_count);
  path_ids[index].ray_count = ray_count;
}

#endif
