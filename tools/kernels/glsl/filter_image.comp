#version 460
// A filter of 9x9 weights over a square image that is sampled, at its texels' centres; the sampler clamps.
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0, std430) writeonly buffer Answer { float filtered[]; };
layout(set = 0, binding = 1) uniform sampler2D image;
layout(set = 0, binding = 2, std430) readonly buffer Weights { float weights[81]; };
layout(push_constant) uniform Constants { int side; };

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  const float texel = 1.0 / float(side);
  float sum = 0.0;
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 9; ++x) {
      const vec2 centre = vec2(at + ivec2(x - 4, y - 4)) + 0.5;
      sum += weights[y * 9 + x] * textureLod(image, centre * texel, 0.0).r;
    }
  }
  filtered[at.y * side + at.x] = sum;
}
