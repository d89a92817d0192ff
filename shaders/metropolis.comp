// Metropolis light transport by ray queries.
#version 460
#extension GL_EXT_ray_query : require
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 16) in;

#include "metropolis/metropolis.glsl"

void main() { metropolis_light_transport(gl_GlobalInvocationID.x); }
