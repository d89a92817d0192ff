// What a ray of a ray tracing pipeline carries.

#ifndef TANDEM_TRACE_PAYLOAD
#define TANDEM_TRACE_PAYLOAD

#ifdef TANDEM_EVENTS
#include "trace/reported_hit.glsl"
#endif

struct RayPayload {
  uint primitive;  // the closest one, written by path_trace.rchit or path_trace.rmiss
  uint random;     // 32 bits that belong to this ray, read by path_trace.rahit; not set where nothing is transparent
#ifdef TANDEM_EVENTS
  ReportedHit hit;  // written by path_log.rchit; not set where nothing is hit
#endif
};

#endif
