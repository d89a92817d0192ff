// A ray, written down, that leaves the scene or reaches the light it was sent to.
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require

#define TANDEM_EVENTS
#include "trace/payload.glsl"
#include "trace/primitive_index.glsl"

layout(location = 0) rayPayloadInEXT RayPayload ray_payload;

void main() { ray_payload.primitive = NO_PRIMITIVE; }
