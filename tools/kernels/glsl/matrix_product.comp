#version 460
// C = A B of square matrices, in tiles of 16x16 elements that a workgroup keeps in shared memory.
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0, std430) writeonly buffer Answer { float c[]; };
layout(set = 0, binding = 1, std430) readonly buffer Left { float a[]; };
layout(set = 0, binding = 2, std430) readonly buffer Right { float b[]; };
layout(push_constant) uniform Constants { uint n; };

shared float tile_a[16][16];
shared float tile_b[16][16];

void main() {
  const uvec2 local = gl_LocalInvocationID.xy;
  const uvec2 at = gl_GlobalInvocationID.xy;
  float sum = 0.0;
  for (uint first = 0; first < n; first += 16) {
    tile_a[local.y][local.x] = a[at.y * n + first + local.x];
    tile_b[local.y][local.x] = b[(first + local.y) * n + at.x];
    barrier();
    for (uint k = 0; k < 16; ++k) sum += tile_a[local.y][k] * tile_b[k][local.x];
    barrier();
  }
  c[at.y * n + at.x] = sum;
}
