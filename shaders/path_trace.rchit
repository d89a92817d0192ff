// The closest hit of a path segment: says which triangle it is.
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require

#include "trace/payload.glsl"
#include "trace/primitive_index.glsl"

layout(location = 0) rayPayloadInEXT RayPayload ray_payload;

void main() { ray_payload.primitive = primitive_index(gl_InstanceCustomIndexEXT, gl_GeometryIndexEXT, gl_PrimitiveID); }
