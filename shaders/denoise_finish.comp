// The last pass of the denoiser: multiplies what was filtered with the albedo and adds what is emitted.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

#include "denoise/pixel.glsl"

layout(set = 0, binding = 0, std430) readonly buffer Pixels { DenoisePixel pixels[]; };
layout(set = 0, binding = 1, std430) readonly buffer Signal { vec4 signal[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Picture { float picture[]; };

void main() {
  uvec2 position = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(position, denoise.resolution))) return;
  uint index = position.y * denoise.resolution.x + position.x;
  precise vec3 color = signal[index].xyz * demodulator(pixels[index].albedo) + pixels[index].emission;
  picture[3 * index] = color.x;
  picture[3 * index + 1] = color.y;
  picture[3 * index + 2] = color.z;
}
