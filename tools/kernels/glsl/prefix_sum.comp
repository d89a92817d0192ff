#version 460
// Exclusive prefix sums of 512 numbers in each workgroup, in shared memory: up a tree of sums, then down (Blelloch 1990).
layout(local_size_x = 256) in;
layout(set = 0, binding = 0, std430) writeonly buffer Answer { uint sums[]; };
layout(set = 0, binding = 1, std430) readonly buffer Numbers { uint numbers[]; };

shared uint tree[512];

void main() {
  const uint local = gl_LocalInvocationID.x;
  const uint first = gl_WorkGroupID.x * 512;
  tree[local] = numbers[first + local];
  tree[local + 256] = numbers[first + local + 256];
  uint stride = 1;
  for (uint count = 256; count > 0; count >>= 1) {
    barrier();
    if (local < count) {
      const uint left = stride * (2 * local + 1) - 1;
      tree[left + stride] += tree[left];
    }
    stride *= 2;
  }
  if (local == 0) tree[511] = 0;
  for (uint count = 1; count < 512; count *= 2) {
    stride >>= 1;
    barrier();
    if (local < count) {
      const uint left = stride * (2 * local + 1) - 1;
      const uint sum = tree[left];
      tree[left] = tree[left + stride];
      tree[left + stride] += sum;
    }
  }
  barrier();
  sums[first + local] = tree[local];
  sums[first + local + 256] = tree[local + 256];
}
