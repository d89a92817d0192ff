// The state of a path as it is recorded, and how a path goes on from one.

#ifndef TANDEM_INTEGRATOR_RECORDED_STATE
#define TANDEM_INTEGRATOR_RECORDED_STATE

#include "integrator/events.glsl"
#include "integrator/path_state.glsl"

// Words of EVENT_SEGMENT: event_word of pathtracer/render/path_event.hpp.
const uint STATE_DEPTH = 2;
const uint STATE_CROSSINGS = 3;
const uint STATE_ORIGIN = 4;
const uint STATE_PREVIOUS_DENSITY = 7;
const uint STATE_DIRECTION = 8;
const uint STATE_ETA_SCALE = 11;
const uint STATE_THROUGHPUT = 12;
const uint STATE_MEDIUM = 15;
const uint STATE_RADIANCE = 16;
const uint STATE_RAY_LENGTH = 19;
const uint STATE_PREVIOUS_POSITION = 20;
const uint STATE_DIFFUSE_COUNT = 23;
const uint STATE_GLOSSY_COUNT = 24;
const uint STATE_SPECULAR_COUNT = 25;
const uint STATE_FIRST_WORD = STATE_DEPTH;  // of what PathStart.state holds

void record_camera(uvec2 pixel, PathState state) {
  write_event(PLACE_CAMERA, EVENT_CAMERA, pixel, event_words(state.origin, state.key.sample_index),
              event_words(state.direction, state.time), uvec4(0), uvec4(0));
}

/// The segment begins that `state` is about: all before it is written down.
void record_segment(PathState state) {
  flush_events();
  recorded_segment = state.segment;
  write_event(PLACE_SEGMENT, EVENT_SEGMENT, uvec2(state.depth, state.segment - state.depth),
              event_words(state.origin, state.previous.density), event_words(state.direction, state.eta_scale),
              event_words(state.throughput, state.medium), event_words(state.radiance, state.ray_length),
              event_words(state.previous.position, state.scattering_count.diffuse),
              uvec4(state.scattering_count.glossy, state.scattering_count.specular, 0, 0), uvec4(0));
}

/// The path is over, and all of it written down. @param reason END_*
void record_end(uint reason, PathState state) {
  write_event(PLACE_END, EVENT_END, uvec2(reason, state.ray_count), event_words(state.radiance, 0u), uvec4(0), uvec4(0),
              uvec4(0));
  flush_events();
}

uint state_word(uint word) {
  uint index = word - STATE_FIRST_WORD;
  return path_starts[recorded_path].state[index / 4][index % 4];
}
precise float state_number(uint word) { return uintBitsToFloat(state_word(word)); }
precise vec3 state_vector(uint word) {
  return vec3(state_number(word), state_number(word + 1), state_number(word + 2));
}

/// The state that the path goes on from; its random numbers remain those of its own pixel and sample.
precise PathState resumed_state(PathState camera) {
  precise PathState state = camera;
  state.depth = state_word(STATE_DEPTH);
  state.segment = state.depth + state_word(STATE_CROSSINGS);
  state.origin = state_vector(STATE_ORIGIN);
  state.direction = state_vector(STATE_DIRECTION);
  state.ray_length = state_number(STATE_RAY_LENGTH);
  state.medium = state_word(STATE_MEDIUM);
  state.throughput = state_vector(STATE_THROUGHPUT);
  state.eta_scale = state_number(STATE_ETA_SCALE);
  state.radiance = state_vector(STATE_RADIANCE);
  state.previous.position = state_vector(STATE_PREVIOUS_POSITION);
  state.previous.density = state_number(STATE_PREVIOUS_DENSITY);
  state.scattering_count.diffuse = state_word(STATE_DIFFUSE_COUNT);
  state.scattering_count.glossy = state_word(STATE_GLOSSY_COUNT);
  state.scattering_count.specular = state_word(STATE_SPECULAR_COUNT);
  return state;
}

#endif
