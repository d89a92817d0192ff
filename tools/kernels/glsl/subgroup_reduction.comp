#version 460
#extension GL_KHR_shader_subgroup_arithmetic : require
// The sum of 4096 numbers in each workgroup: by subgroups, whose sums meet in shared memory.
layout(local_size_x = 256) in;
layout(set = 0, binding = 0, std430) writeonly buffer Answer { float sums[]; };
layout(set = 0, binding = 1, std430) readonly buffer Numbers { float numbers[]; };

shared float partial[256];  // as many subgroups as there may be

void main() {
  const uint first = gl_WorkGroupID.x * 4096 + gl_LocalInvocationID.x;
  float sum = 0.0;
  for (uint i = 0; i < 16; ++i) sum += subgroupAdd(numbers[first + i * 256]);
  if (subgroupElect()) partial[gl_SubgroupID] = sum;
  barrier();
  if (gl_SubgroupID == 0) {
    float rest = 0.0;
    for (uint i = gl_SubgroupInvocationID; i < gl_NumSubgroups; i += gl_SubgroupSize) rest += partial[i];
    rest = subgroupAdd(rest);
    if (subgroupElect()) sums[gl_WorkGroupID.x] = rest;
  }
}
