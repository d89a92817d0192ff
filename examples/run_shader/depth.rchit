// What is near is bright, in the colour of the shader record.
#version 460
#extension GL_EXT_ray_tracing : require

layout(location = 0) rayPayloadInEXT vec3 color;
layout(shaderRecordEXT) buffer Record { vec3 tint; };

void main() { color = tint * exp(-gl_HitTEXT / 1000.0); }
