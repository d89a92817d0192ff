// What an invocation does that writes down the events of one path. Of the dispatch constants, tile_size.x is the number
// of paths.

#ifndef TANDEM_PATH_LOG
#define TANDEM_PATH_LOG

#define TANDEM_EVENTS
#include "integrator/path.glsl"
#include "scene.glsl"

void path_log(uint index) {
  if (index >= dispatch.tile_size.x) return;
  recorded_path = index;
  uint ray_count = 0;
  precise vec3 radiance = path_radiance(path_starts[index].pixel, path_starts[index].sample_index, ray_count);
  flush_events();
  path_summaries[index].radiance = radiance;
  path_summaries[index].ray_count = ray_count;
  path_summaries[index].event_count = event_count;
  path_summaries[index].digest = event_digest;
}

#endif
