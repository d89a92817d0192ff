// A ray that meets nothing.
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require

#include "probe/answer.glsl"

layout(location = 0) rayPayloadInEXT ProbeAnswer payload;

void main() { payload = empty_answer(ANSWER_MISS); }
