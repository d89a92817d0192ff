// What an invocation does that writes down the events of one path. Of the dispatch constants, tile_size.x is the number
// of paths.

#ifndef TANDEM_PATH_LOG
#define TANDEM_PATH_LOG

#define TANDEM_EVENTS
#include "integrator/ambient_occlusion.glsl"
#include "integrator/options.glsl"
#include "integrator/path.glsl"
#include "integrator/path_state.glsl"
#include "integrator/recorded_state.glsl"
#include "scene.glsl"

void path_log(uint index) {
  if (index >= dispatch.tile_size.x) return;
  recorded_path = index;
  precise PathState state = camera_state(path_starts[index].pixel, path_starts[index].sample_index);
  if (path_starts[index].has_state == HAS_STATE) {
    state = resumed_state(state);
  } else {
    record_camera(path_starts[index].pixel, state);
  }
  bool occlusion = option_integrator() == INTEGRATOR_AMBIENT_OCCLUSION;
  uint end = CONTINUES;
  for (uint i = 0; end == CONTINUES; ++i) {
    record_segment(state);
    if (i == path_starts[index].segment_count) {
      end = END_LIMIT;
    } else if (occlusion) {
      end = ambient_occlusion_segment(state);
    } else {
      end = path_segment(state);
    }
  }
  record_end(end, state);
  path_summaries[index].radiance = state.radiance;
  path_summaries[index].ray_count = state.ray_count;
  path_summaries[index].event_count = event_count;
  path_summaries[index].digest = event_digest;
}

#endif
