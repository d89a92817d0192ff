// The closest hit: all that the device reports of it.
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require

#include "probe/answer.glsl"

layout(location = 0) rayPayloadInEXT ProbeAnswer payload;
layout(shaderRecordEXT, std430) buffer Record { uint number; } record;
hitAttributeEXT vec2 barycentrics;

void main() {
  payload = empty_answer(gl_HitKindEXT == HIT_KIND_SPHERE ? ANSWER_SPHERE : ANSWER_TRIANGLE);
  payload.instance = uint(gl_InstanceID);
  payload.custom_index = uint(gl_InstanceCustomIndexEXT);
  payload.record = record.number;
  payload.geometry = uint(gl_GeometryIndexEXT);
  payload.primitive = uint(gl_PrimitiveID);
  payload.hit_kind = gl_HitKindEXT;
  payload.t = gl_HitTEXT;
  if (payload.type == ANSWER_TRIANGLE) {
    payload.barycentrics[0] = barycentrics.x;
    payload.barycentrics[1] = barycentrics.y;
  }
  set_object_space(payload, gl_ObjectRayOriginEXT, gl_ObjectRayDirectionEXT, gl_ObjectToWorldEXT, gl_WorldToObjectEXT);
}
