// Writes down the rays of an invocation, in the order in which they are traced.

#ifndef TANDEM_TRACE_RAY_LOG
#define TANDEM_TRACE_RAY_LOG

#include "trace/traced_ray.glsl"

layout(set = 1, binding = 2, std430) writeonly buffer RayLog { TracedRay ray_log[]; };

uint ray_log_end = 0;  // where in the log the next ray goes

void log_ray(TracedRay ray) {
  ray_log[ray_log_end] = ray;
  ray_log_end += 1;
}

#endif
