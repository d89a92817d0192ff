// The recorder: the events of a path, for whoever wants to know where two devices part. With TANDEM_EVENTS the integrator
// writes them down; without, the calls below are macros that leave nothing, and their arguments are not evaluated.
// pathtracer/render/path_event.hpp says the same on the host, compare/path/event_fields.cpp what the words of each event
// mean.

#ifndef TANDEM_INTEGRATOR_EVENTS
#define TANDEM_INTEGRATOR_EVENTS

#ifndef TANDEM_EVENTS

#define record_closest_ray(origin, direction, t_max, dimension, primitive, hit)
#define record_shadow_ray(origin, direction, t_max, dimension, occluded)
#define record_surface(surface)
#define record_medium(bits, reached)
#define record_emission(environment, radiance, contribution)
#define record_light_sample(bits, light)
#define record_light_value(found, weight)
#define record_visibility(visible)
#define record_direct_light(contribution)
#define record_scatter(bits, vertex, scattered, leaves, direction)
#define record_roulette(bits, survival, survives)
#define flush_events()

#else

#include "bsdf/bsdf_sample.glsl"
#include "geometry/surface.glsl"
#include "integrator/medium.glsl"
#include "integrator/vertex.glsl"
#include "light/light_sample.glsl"
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
uint event_count = 0;
uint event_digest = 2166136261u;

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

void record_ray(uint place, uint kind, uint dimension, vec3 origin, float t_max, vec3 direction, uint answer,
                ReportedHit hit) {
  write_event(place, EVENT_RAY, uvec2(kind, dimension), event_words(origin, t_max), event_words(direction, answer),
              uvec4(hit.kind, hit.instance_custom_index, hit.geometry_index, hit.primitive_index), uvec4(0), uvec4(0),
              uvec4(0), floatBitsToUint(vec4(hit.t, hit.barycentrics, 0.0)));
}

void record_closest_ray(vec3 origin, vec3 direction, float t_max, uint dimension, uint primitive, ReportedHit hit) {
  record_ray(PLACE_CLOSEST_RAY, RAY_CLOSEST, dimension, origin, t_max, direction, primitive, hit);
}

void record_shadow_ray(vec3 origin, vec3 direction, float t_max, uint dimension, bool occluded) {
  record_ray(PLACE_SHADOW_RAY, RAY_OCCLUSION, dimension, origin, t_max, direction, occluded ? 1u : 0u,
             no_reported_hit());
}

void record_surface(Surface surface) {
  write_event(PLACE_SURFACE, EVENT_SURFACE, uvec2(surface.material, surface.outside ? 1u : 0u),
              event_words(surface.position, surface.offset), event_words(surface.geometric_normal, 0u),
              event_words(surface.shading_normal, 0u), uvec4(floatBitsToUint(surface.texture_coordinates), 0, 0));
}

void record_medium(uvec2 bits, MediumSample reached) {
  write_event(PLACE_MEDIUM, EVENT_MEDIUM, bits, event_words(reached.weight, reached.distance),
              uvec4(reached.scattered ? 1u : 0u, 0, 0, 0), uvec4(0), uvec4(0));
}

/// @param radiance that arrives, weighted against next event estimation @param contribution what is added to the path's
void record_emission(bool environment, vec3 radiance, vec3 contribution) {
  write_event(PLACE_EMISSION, EVENT_EMISSION, uvec2(environment ? 1u : 0u, 0), event_words(radiance, 0u),
              event_words(contribution, 0u), uvec4(0), uvec4(0));
}

void record_light_sample(uvec4 bits, LightSample light) {
  write_event(PLACE_LIGHT_SAMPLE, EVENT_LIGHT_SAMPLE, uvec2(light.primitive, light.infinite ? 1u : 0u), bits,
              event_words(light.direction, light.density), event_words(light.radiance, 0u),
              event_words(light.target, 0u));
}

/// @param found the BSDF times the cosine, or the phase function, and its density @param weight over the density
void record_light_value(BsdfValue found, float weight) {
  write_event(PLACE_LIGHT_VALUE, EVENT_LIGHT_VALUE, uvec2(0), event_words(found.value, found.density),
              event_words(vec3(0.0), weight), uvec4(0), uvec4(0));
}

void record_visibility(vec3 visible) {
  write_event(PLACE_VISIBILITY, EVENT_VISIBILITY, uvec2(0), event_words(visible, 0u), uvec4(0), uvec4(0), uvec4(0));
}

void record_direct_light(vec3 contribution) {
  write_event(PLACE_DIRECT_LIGHT, EVENT_DIRECT_LIGHT, uvec2(0), event_words(contribution, 0u), uvec4(0), uvec4(0),
              uvec4(0));
}

const uint NO_MATERIAL_MODEL = 0xffffffffu;  // of a vertex within a medium

/// @param direction in world space
void record_scatter(uvec4 bits, Vertex vertex, BsdfSample scattered, bool leaves, vec3 direction) {
  uint model = vertex.in_medium ? NO_MATERIAL_MODEL : vertex.parameters.model;
  write_event(PLACE_SCATTER, EVENT_SCATTER, uvec2(scattered.lobe, leaves ? 1u : 0u), bits,
              event_words(direction, scattered.density), event_words(scattered.weight, scattered.eta),
              uvec4(model, 0, 0, 0));
}

void record_roulette(uint bits, float survival, bool survives) {
  write_event(PLACE_ROULETTE, EVENT_ROULETTE, uvec2(survives ? 1u : 0u, bits),
              uvec4(floatBitsToUint(survival), 0, 0, 0), uvec4(0), uvec4(0), uvec4(0));
}

#endif
#endif
