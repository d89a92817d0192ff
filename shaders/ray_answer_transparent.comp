// Traces rays again by ray queries, for scenes with transparent triangles.
#version 460
#extension GL_EXT_ray_query : require
#extension GL_GOOGLE_include_directive : require

#define TANDEM_TRANSPARENCY

layout(local_size_x = 64) in;

#include "ray_answer.glsl"

void main() { ray_answer(gl_GlobalInvocationID.x); }
