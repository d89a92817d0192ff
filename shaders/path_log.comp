// Writes down the rays of paths by ray queries.
#version 460
#extension GL_EXT_ray_query : require
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;

#include "path_log.glsl"

void main() { path_log(gl_GlobalInvocationID.x); }
