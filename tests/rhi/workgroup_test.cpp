#include <doctest/doctest.h>

#include <algorithm>

#include "tests/rhi/dispatch.hpp"

using namespace tandem;
using test::contents;

namespace {

using Words = std::vector<std::uint32_t>;

Words run(rhi::Device& device, const std::string& glsl, std::size_t words, std::uint32_t workgroups) {
  const rhi::BufferHandle buffer = test::buffer_of(device, Words(words), "words");
  test::run(device, test::compute_pipeline(device, "#version 460\n" + glsl, "groups"), {buffer}, workgroups);
  return contents<std::uint32_t>(device, buffer, words);
}

}  // namespace

TANDEM_DEVICE_TEST("invocations of a workgroup share memory, in the order of their barriers") {
  const Words words = run(device, R"(
layout(local_size_x = 16, local_size_y = 8) in;
layout(binding = 0) buffer B { uint b[]; };
struct Item { uint value; bvec2 flags; vec3 parts[2]; };
shared uint sums[128];
shared Item items[4];
shared uint counter;
uint scan(uint x) {
  uint i = gl_LocalInvocationIndex;
  sums[i] = x;
  barrier();
  for (uint step = 1; step < 128; step *= 2) {
    uint left = i >= step ? sums[i - step] : 0;
    barrier();
    sums[i] += left;
    barrier();
  }
  return sums[i];
}
void main() {
  uint i = gl_LocalInvocationIndex;
  if (i == 0) counter = 0;
  if (i < 4) {
    items[i].value = i + gl_WorkGroupID.x;
    items[i].flags = bvec2(i == 1, true);
    items[i].parts[1].y = float(i);
  }
  uint sum = scan(i + gl_WorkGroupID.x);
  atomicAdd(counter, i);
  barrier();
  Item item = items[(i + 1) % 4];
  b[gl_WorkGroupID.x * 128 + i] = sum * 100 + item.value + uint(item.flags.x) * 10 + uint(item.parts[1].y) + counter;
}
)",
                          3 * 128, 3);
  for (std::uint32_t group = 0; group < 3; ++group)
    for (std::uint32_t i = 0; i < 128; ++i) {
      const std::uint32_t next = (i + 1) % 4, sum = (i + 1) * i / 2 + group * (i + 1);
      REQUIRE(words[group * 128 + i] == sum * 100 + next + group + (next == 1 ? 10 : 0) + next + 127 * 64);
    }
}

TANDEM_DEVICE_TEST("invocations of a subgroup tell each other their values") {
  const std::vector<std::uint32_t>& known = device.info().spirv_capabilities;
  constexpr std::uint32_t group_non_uniform_shuffle = 65;
  if (!std::binary_search(known.begin(), known.end(), group_non_uniform_shuffle)) return;
  const Words words = run(device, R"(
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_shuffle : require
layout(local_size_x = 128) in;
layout(binding = 0) buffer B { uint b[]; };
void main() {
  uint i = gl_LocalInvocationIndex, row = i * 8;
  b[row] = gl_SubgroupSize;
  b[row + 1] = gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;
  b[row + 2] = subgroupAdd(i);
  b[row + 3] = subgroupExclusiveAdd(i + 1);
  b[row + 4] = uint(subgroupAll(i < 64)) | uint(subgroupAny(i == 70)) << 1 | uint(subgroupElect()) << 2;
  b[row + 5] = subgroupShuffle(i, gl_SubgroupInvocationID ^ 1);
  if (i % 2 == 1) {
    b[row + 6] = subgroupBroadcastFirst(i);
    uint sum = 0;
    for (uint k = 0; k < 1 + i % 4; ++k) sum += subgroupBallotBitCount(subgroupBallot(true));
    b[row + 7] = sum;
  }
}
)",
                          128 * 8, 1);
  const std::uint32_t size = words[0];
  REQUIRE(size >= 4);
  for (std::uint32_t i = 0; i < 128; ++i) {
    CAPTURE(i);
    const std::uint32_t first = i / size * size, last = std::min(first + size, 128u);
    const std::uint32_t* row = &words[i * 8];
    const std::uint32_t id = i - first;
    CHECK(row[0] == size);
    CHECK(row[1] == i);
    CHECK(row[2] == (first + last - 1) * (last - first) / 2);
    CHECK(row[3] == (first + i + 1) * id / 2);
    CHECK(row[4] == ((last <= 64 ? 1u : 0u) | (first <= 70 && last > 70 ? 2u : 0u) | (id == 0 ? 4u : 0u)));
    CHECK(row[5] == (i ^ 1));
    CHECK(row[6] == (i % 2 == 1 ? first + 1 : 0));
    // Half of them in the first two rounds, a quarter in the others.
    const std::uint32_t n = last - first;
    CHECK(row[7] == (i % 2 == 0 ? 0 : i % 4 == 1 ? n : 2 * n / 2 + 2 * n / 4));
  }
}
