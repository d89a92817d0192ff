#version 460
// Sorts 512 keys in each workgroup, in shared memory, by a bitonic network (Batcher 1968).
layout(local_size_x = 256) in;
layout(set = 0, binding = 0, std430) writeonly buffer Answer { uint sorted[]; };
layout(set = 0, binding = 1, std430) readonly buffer Keys { uint unsorted[]; };

shared uint keys[512];

void main() {
  const uint local = gl_LocalInvocationID.x;
  const uint first = gl_WorkGroupID.x * 512;
  keys[local] = unsorted[first + local];
  keys[local + 256] = unsorted[first + local + 256];
  for (uint run = 2; run <= 512; run *= 2) {
    for (uint stride = run / 2; stride > 0; stride /= 2) {
      barrier();
      const uint low = 2 * local - (local & (stride - 1));
      const uint a = keys[low];
      const uint b = keys[low + stride];
      const bool ascending = (low & run) == 0;
      if ((a > b) == ascending) {
        keys[low] = b;
        keys[low + stride] = a;
      }
    }
  }
  barrier();
  sorted[first + local] = keys[local];
  sorted[first + local + 256] = keys[local + 256];
}
