// Traces rays again by ray queries.
#version 460
#extension GL_EXT_ray_query : require
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;

#include "ray_answer.glsl"

void main() { ray_answer(gl_GlobalInvocationID.x); }
