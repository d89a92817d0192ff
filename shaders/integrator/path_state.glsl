// A path between two segments, and why paths end.

#ifndef TANDEM_INTEGRATOR_PATH_STATE
#define TANDEM_INTEGRATOR_PATH_STATE

#include "camera/camera.glsl"
#include "integrator/options.glsl"
#include "trace.glsl"

/// The vertex that scattered the ray of a segment: what decides how much a light counts that the ray meets.
struct PreviousVertex {
  vec3 position;
  float density;  // of the ray's direction, per solid angle; 0 if next event estimation could not have found it
};

/// All that the rest of a path depends on. A PathState is declared `precise`, as a parameter too: its members go
/// through function calls into their own next values (docs/internals/shaders.md).
struct PathState {
  RandomKey key;    // which path it is
  float time;       // shutter_time(key)
  uint segment;     // segments before this one: by their number they have their random numbers
  uint depth;       // of them, those that ended at a vertex; others ended at the boundary of a medium
  vec3 origin;      // of the segment's ray
  vec3 direction;   // unit
  float ray_length;  // how far the ray reaches
  uint medium;      // around the origin: index into media, or NO_MEDIUM
  vec3 throughput;
  float eta_scale;  // the product of eta^2 since the camera; the throughput holds its inverse
  vec3 radiance;    // that the path has gathered
  PreviousVertex previous;
  ScatteringCount scattering_count;
  uint ray_count;   // rays that were traced for the path
};

// What a segment comes to: the path goes on, or ends.
const uint CONTINUES = 0xffffffffu;
const uint END_ESCAPED = 0;    // left the scene
const uint END_DEPTH = 1;      // was as long as settings allow
const uint END_ABSORBED = 2;   // carried nothing any more
const uint END_ROULETTE = 3;
const uint END_SIDE = 4;       // was scattered to the wrong side of the true surface
const uint END_CROSSINGS = 5;  // crossed too many boundaries
const uint END_OCCLUDED = 6;   // ambient occlusion: met something
const uint END_LIMIT = 7;      // as many segments are recorded as were asked for

/// A path through a pixel before its first segment.
precise PathState camera_state(uvec2 pixel, uint sample_index) {
  precise PathState state;
  state.key.pixel = pixel.x + (pixel.y << 16);
  state.key.sample_index = sample_index;
  state.key.seed = render.seed;
  state.time = shutter_time(state.key);
  precise CameraRay camera = camera_ray(pixel, state.key, state.time);
  state.segment = 0;
  state.depth = 0;
  state.origin = camera.origin;
  state.direction = camera.direction;
  state.ray_length = RAY_LENGTH;
  state.medium = render.medium;
  state.throughput = vec3(1.0);
  state.eta_scale = 1.0;
  state.radiance = vec3(0.0);
  state.previous.position = camera.origin;
  state.previous.density = 0.0;
  state.scattering_count.diffuse = 0;
  state.scattering_count.glossy = 0;
  state.scattering_count.specular = 0;
  state.ray_count = 0;
  return state;
}

#endif
