#version 460
// A filter of 9x9 weights over a square image in a buffer, whose edge pixels continue outside.
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0, std430) writeonly buffer Answer { float filtered[]; };
layout(set = 0, binding = 1, std430) readonly buffer Pixels { float pixels[]; };
layout(set = 0, binding = 2, std430) readonly buffer Weights { float weights[81]; };
layout(push_constant) uniform Constants { int side; };

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  float sum = 0.0;
  for (int y = 0; y < 9; ++y) {
    const int row = clamp(at.y + y - 4, 0, side - 1) * side;
    for (int x = 0; x < 9; ++x) sum += weights[y * 9 + x] * pixels[row + clamp(at.x + x - 4, 0, side - 1)];
  }
  filtered[at.y * side + at.x] = sum;
}
