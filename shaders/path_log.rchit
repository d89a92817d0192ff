// The closest hit of a path segment whose events are written down: says which triangle it is, and what else the device
// knows of it.
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require

#define TANDEM_EVENTS
#include "trace/payload.glsl"
#include "trace/primitive_index.glsl"

layout(location = 0) rayPayloadInEXT RayPayload ray_payload;
hitAttributeEXT vec2 barycentrics;

void main() {
  ray_payload.primitive = primitive_index(gl_InstanceCustomIndexEXT, gl_GeometryIndexEXT, gl_PrimitiveID);
  ray_payload.hit.kind = HIT_PROCEDURAL;
  ray_payload.hit.instance_custom_index = uint(gl_InstanceCustomIndexEXT);
  ray_payload.hit.geometry_index = uint(gl_GeometryIndexEXT);
  ray_payload.hit.primitive_index = uint(gl_PrimitiveID);
  ray_payload.hit.t = gl_HitTEXT;
  ray_payload.hit.barycentrics = vec2(0.0);
  if (gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT || gl_HitKindEXT == gl_HitKindBackFacingTriangleEXT) {
    ray_payload.hit.kind = gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT ? HIT_FRONT : HIT_BACK;
    ray_payload.hit.barycentrics = barycentrics;
  }
}
