// How a ray is traced, and the only file that knows. An entry point says by macros which way is meant:
//   TANDEM_TRACE_PIPELINE  a ray tracing pipeline, else ray queries
//   TANDEM_TRANSPARENCY    triangles from render.opaque_count on may let rays pass, else all are opaque
// Both ways give the same answers, to the last bit: what decides whether a triangle counts depends on the ray and the
// triangle only (geometry/opacity.glsl), not on the order in which a device offers them.

#ifndef TANDEM_TRACE
#define TANDEM_TRACE

#include "trace/triangle_index.glsl"

// Farther than anything in a scene of floats whose squares are floats.
const float RAY_LENGTH = 1e30;

#ifdef TANDEM_TRACE_PIPELINE
#include "trace/pipeline.glsl"
#else
#include "trace/query.glsl"
#endif

#endif
