// What each pixel shows first, by ray queries.
#version 460
#extension GL_EXT_ray_query : require
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

#include "first_hit.glsl"

void main() { first_hit(gl_GlobalInvocationID.xy); }
