// What a ray of a ray tracing pipeline carries.

#ifndef TANDEM_TRACE_PAYLOAD
#define TANDEM_TRACE_PAYLOAD

struct RayPayload {
  uint primitive;  // the closest one, written by path_trace.rchit or path_trace.rmiss
  uint random;     // 32 bits that belong to this ray, read by path_trace.rahit; not set where nothing is transparent
};

#endif
