// The events of a path, for whoever wants to know where two devices part. With TANDEM_EVENTS the integrator writes them
// down; without, TANDEM_RECORD leaves nothing of what it encloses, and the shader is the same to the last byte.
// pathtracer/render/path_event.hpp says the same on the host, compare/path/event_fields.cpp what the words of each event mean.

#ifndef TANDEM_INTEGRATOR_EVENTS
#define TANDEM_INTEGRATOR_EVENTS

#ifndef TANDEM_EVENTS

#define TANDEM_RECORD(statement)
#define PATH_FIRST_DEPTH 0

#else

#define TANDEM_RECORD(statement) statement
#define PATH_FIRST_DEPTH resumed_depth

#include "trace/reported_hit.glsl"
#include "trace/traced_ray.glsl"

const uint EVENT_CAMERA = 1;        // the path begins
const uint EVENT_SEGMENT = 2;       // a segment begins: all that the rest of the path depends on
const uint EVENT_RAY = 3;           // a ray was traced
const uint EVENT_SURFACE = 4;       // the segment met a surface
const uint EVENT_MEDIUM = 5;        // the segment ran through a medium
const uint EVENT_EMISSION = 6;      // light that the segment met
const uint EVENT_LIGHT_SAMPLE = 7;  // a light was chosen
const uint EVENT_LIGHT_VALUE = 8;   // it may light the vertex
const uint EVENT_VISIBILITY = 9;    // how much of it arrives
const uint EVENT_DIRECT_LIGHT = 10;  // what it adds
const uint EVENT_SCATTER = 11;      // the vertex scattered
const uint EVENT_ROULETTE = 12;
const uint EVENT_END = 13;

const uint END_ESCAPED = 0;   // left the scene
const uint END_DEPTH = 1;     // was as long as settings allow
const uint END_ABSORBED = 2;  // carried nothing any more
const uint END_ROULETTE = 3;
const uint END_SIDE = 4;      // was scattered to the wrong side of the true surface
const uint END_CROSSINGS = 5;  // crossed too many boundaries
const uint END_OCCLUDED = 6;  // ambient occlusion: met something
const uint END_LIMIT = 7;     // as many segments are recorded as were asked for

struct PathEvent {
  uvec4 words[8];  // words[0].x: EVENT_*, words[0].y: the segment; the rest depends
};

const uint NO_STATE = 0;
const uint HAS_STATE = 1;

struct PathStart {
  uvec2 pixel;
  uint sample_index;
  uint has_state;      // HAS_STATE: the path begins with the segment whose EVENT_SEGMENT `state` is; NO_STATE: at the camera
  uint segment_count;  // it ends after so many segments
  uint first_event;    // where in the log its events go
  uint capacity;       // how many of them; the others are only counted
  uint reserved;
  uvec4 state[6];      // words 2 to 25 of the event
};

struct PathSummary {
  vec3 radiance;
  uint ray_count;
  uint event_count;
  uint digest;  // of all recorded words except what devices report of a hit beyond the primitive
  uint reserved_0;
  uint reserved_1;
};

layout(set = 1, binding = 2, std430) writeonly buffer EventLog { PathEvent event_log[]; };
layout(set = 1, binding = 3, std430) readonly buffer PathStarts { PathStart path_starts[]; };
layout(set = 1, binding = 4, std430) writeonly buffer PathSummaries { PathSummary path_summaries[]; };

uint recorded_path = 0;  // of the invocation
uint recorded_segment = 0;
uint recorded_segment_count = 0;
uint event_count = 0;
uint event_digest = 2166136261u;
uint resumed_depth = 0;

// Events wait here until the segment is over, each kind in a place of its own, and are written out in one place of the
// program: drivers' compilers take minutes where every event is written where it happens. Places are in the order of
// events.
const uint PLACE_CAMERA = 0;
const uint PLACE_SEGMENT = 1;
const uint PLACE_CLOSEST_RAY = 2;
const uint PLACE_SURFACE = 3;
const uint PLACE_MEDIUM = 4;
const uint PLACE_EMISSION = 5;
const uint PLACE_LIGHT_SAMPLE = 6;
const uint PLACE_LIGHT_VALUE = 7;
const uint PLACE_SHADOW_RAY = 8;
const uint PLACE_VISIBILITY = 9;
const uint PLACE_DIRECT_LIGHT = 10;
const uint PLACE_SCATTER = 11;
const uint PLACE_ROULETTE = 12;
const uint PLACE_END = 13;
const uint PLACE_COUNT = 14;

uvec4 waiting_words[8 * PLACE_COUNT];
uint waiting_places = 0;  // bit i: there is an event in place i

/// Writes down what waits.
void flush_events() {
  for (uint i = 0; i < 8 * PLACE_COUNT; ++i) {
    if ((waiting_places >> (i / 8) & 1u) == 0) continue;
    uvec4 words = waiting_words[i];
    if (i % 8 != 7) {
      // FNV-1a over words (Fowler, Noll, Vo).
      event_digest = (event_digest ^ words.x) * 16777619u;
      event_digest = (event_digest ^ words.y) * 16777619u;
      event_digest = (event_digest ^ words.z) * 16777619u;
      event_digest = (event_digest ^ words.w) * 16777619u;
    }
    if (event_count < path_starts[recorded_path].capacity)
      event_log[path_starts[recorded_path].first_event + event_count].words[i % 8] = words;
    if (i % 8 == 7) event_count += 1;
  }
  waiting_places = 0;
}

/// `unseen`: words that do not enter the digest.
void write_event(uint place, uint kind, uvec2 first, uvec4 a, uvec4 b, uvec4 c, uvec4 d, uvec4 e, uvec4 f,
                 uvec4 unseen) {
  waiting_words[8 * place] = uvec4(kind, recorded_segment, first);
  waiting_words[8 * place + 1] = a;
  waiting_words[8 * place + 2] = b;
  waiting_words[8 * place + 3] = c;
  waiting_words[8 * place + 4] = d;
  waiting_words[8 * place + 5] = e;
  waiting_words[8 * place + 6] = f;
  waiting_words[8 * place + 7] = unseen;
  waiting_places |= 1u << place;
}

void write_event(uint place, uint kind, uvec2 first, uvec4 a, uvec4 b, uvec4 c, uvec4 d) {
  write_event(place, kind, first, a, b, c, d, uvec4(0), uvec4(0), uvec4(0));
}

uvec4 event_words(vec3 vector, uint word) { return uvec4(floatBitsToUint(vector), word); }
uvec4 event_words(vec3 vector, float number) { return floatBitsToUint(vec4(vector, number)); }

void event_camera(uvec2 pixel, uint sample_index, float time, vec3 origin, vec3 direction) {
  write_event(PLACE_CAMERA, EVENT_CAMERA, pixel, event_words(origin, sample_index), event_words(direction, time), uvec4(0), uvec4(0));
}

/// Whether the segment is to be traced. All before it is written down.
bool event_segment(uint depth, uint crossings, vec3 origin, vec3 direction, float ray_length, vec3 throughput,
                   vec3 radiance, float eta_scale, uint medium, vec3 previous_position, float previous_density,
                   uint diffuse_count, uint glossy_count, uint specular_count) {
  flush_events();
  recorded_segment = depth + crossings;
  write_event(PLACE_SEGMENT, EVENT_SEGMENT, uvec2(depth, crossings), event_words(origin, previous_density),
              event_words(direction, eta_scale), event_words(throughput, medium), event_words(radiance, ray_length),
              event_words(previous_position, diffuse_count), uvec4(glossy_count, specular_count, 0, 0), uvec4(0));
  recorded_segment_count += 1;
  return recorded_segment_count <= path_starts[recorded_path].segment_count;
}

void event_ray(uint kind, uint dimension, vec3 origin, float t_max, vec3 direction, uint answer, ReportedHit hit) {
  uint place = kind == RAY_CLOSEST ? PLACE_CLOSEST_RAY : PLACE_SHADOW_RAY;
  write_event(place, EVENT_RAY, uvec2(kind, dimension), event_words(origin, t_max), event_words(direction, answer),
              uvec4(hit.kind, hit.instance_custom_index, hit.geometry_index, hit.primitive_index), uvec4(0), uvec4(0),
              uvec4(0), floatBitsToUint(vec4(hit.t, hit.barycentrics, 0.0)));
}

void event_surface(uint material, bool outside, vec3 position, float offset, vec3 geometric_normal, vec3 shading_normal,
                   vec2 texture_coordinates) {
  write_event(PLACE_SURFACE, EVENT_SURFACE, uvec2(material, outside ? 1u : 0u), event_words(position, offset),
              event_words(geometric_normal, 0u), event_words(shading_normal, 0u),
              uvec4(floatBitsToUint(texture_coordinates), 0, 0));
}

void event_medium(uvec2 bits, bool scattered, float distance, vec3 weight) {
  write_event(PLACE_MEDIUM, EVENT_MEDIUM, bits, event_words(weight, distance), uvec4(scattered ? 1u : 0u, 0, 0, 0), uvec4(0),
              uvec4(0));
}

/// @param radiance that arrives, weighted against next event estimation @param contribution what is added to the path's
void event_emission(bool environment, vec3 radiance, vec3 contribution) {
  write_event(PLACE_EMISSION, EVENT_EMISSION, uvec2(environment ? 1u : 0u, 0), event_words(radiance, 0u),
              event_words(contribution, 0u), uvec4(0), uvec4(0));
}

void event_light_sample(uvec4 bits, uint primitive, bool infinite, vec3 direction, vec3 radiance, float density,
                        vec3 target) {
  write_event(PLACE_LIGHT_SAMPLE, EVENT_LIGHT_SAMPLE, uvec2(primitive, infinite ? 1u : 0u), bits, event_words(direction, density),
              event_words(radiance, 0u), event_words(target, 0u));
}

/// @param value of the BSDF or phase function, times the cosine @param weight over the density
void event_light_value(vec3 value, float density, float weight) {
  write_event(PLACE_LIGHT_VALUE, EVENT_LIGHT_VALUE, uvec2(0), event_words(value, density), event_words(vec3(0.0), weight), uvec4(0),
              uvec4(0));
}

void event_visibility(vec3 visible) {
  write_event(PLACE_VISIBILITY, EVENT_VISIBILITY, uvec2(0), event_words(visible, 0u), uvec4(0), uvec4(0), uvec4(0));
}

void event_direct_light(vec3 contribution) {
  write_event(PLACE_DIRECT_LIGHT, EVENT_DIRECT_LIGHT, uvec2(0), event_words(contribution, 0u), uvec4(0), uvec4(0), uvec4(0));
}

/// @param model MATERIAL_*, or NO_MATERIAL_MODEL within a medium @param direction in world space
void event_scatter(uvec4 bits, uint model, uint lobe, bool leaves, vec3 direction, vec3 weight, float density,
                   float eta) {
  write_event(PLACE_SCATTER, EVENT_SCATTER, uvec2(lobe, leaves ? 1u : 0u), bits, event_words(direction, density),
              event_words(weight, eta), uvec4(model, 0, 0, 0));
}

const uint NO_MATERIAL_MODEL = 0xffffffffu;

void event_roulette(uint bits, float survival, bool survives) {
  write_event(PLACE_ROULETTE, EVENT_ROULETTE, uvec2(survives ? 1u : 0u, bits), uvec4(floatBitsToUint(survival), 0, 0, 0), uvec4(0),
              uvec4(0), uvec4(0));
}

/// @param reason END_*
void event_end(uint reason, vec3 radiance, uint ray_count) {
  write_event(PLACE_END, EVENT_END, uvec2(reason, ray_count), event_words(radiance, 0u), uvec4(0), uvec4(0), uvec4(0));
}

bool resumes_path() { return path_starts[recorded_path].has_state == HAS_STATE; }

/// Word `index` of the EVENT_SEGMENT that the path begins with.
uint state_word(uint index) { return path_starts[recorded_path].state[(index - 2) / 4][(index - 2) % 4]; }
float state_number(uint index) { return uintBitsToFloat(state_word(index)); }
vec3 state_vector(uint index) { return vec3(state_number(index), state_number(index + 1), state_number(index + 2)); }

#endif
#endif
