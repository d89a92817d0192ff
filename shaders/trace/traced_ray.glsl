// A ray of the path tracer and its answer: pathtracer/render/traced_ray.hpp says the same on the host.

#ifndef TANDEM_TRACE_TRACED_RAY
#define TANDEM_TRACE_TRACED_RAY

const uint RAY_CLOSEST = 0;
const uint RAY_OCCLUSION = 1;

struct TracedRay {
  vec3 origin;
  float t_max;
  vec3 direction;
  uint kind;          // RAY_*
  uint answer;        // closest: the primitive, or NO_PRIMITIVE; occlusion: 1 or 0
  uint pixel;         // of its RandomKey
  uint sample_index;  // likewise
  uint dimension;
};

#endif
