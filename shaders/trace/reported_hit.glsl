// What a device reports of a closest hit, beyond the primitive that the path tracer asks for. No result depends on it.

#ifndef TANDEM_TRACE_REPORTED_HIT
#define TANDEM_TRACE_REPORTED_HIT

const uint HIT_NONE = 0;
const uint HIT_FRONT = 1;  // of a triangle: seen counter-clockwise
const uint HIT_BACK = 2;
const uint HIT_PROCEDURAL = 3;

struct ReportedHit {
  uint kind;  // HIT_*; what follows is 0 for HIT_NONE
  uint instance_custom_index;
  uint geometry_index;
  uint primitive_index;  // within the geometry
  float t;
  vec2 barycentrics;     // of a triangle
};

precise ReportedHit no_reported_hit() {
  ReportedHit hit;
  hit.kind = HIT_NONE;
  hit.instance_custom_index = 0;
  hit.geometry_index = 0;
  hit.primitive_index = 0;
  hit.t = 0.0;
  hit.barycentrics = vec2(0.0);
  return hit;
}

#endif
