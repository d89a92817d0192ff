// Shared memory and barriers on the CPU device.

#include <doctest/doctest.h>

#include <chrono>
#include <numeric>

#include "rhi/error.hpp"
#include "rhi_cpu/device.hpp"
#include "tests/rhi_cpu/groups/device.hpp"

namespace tandem::cpu::test {
namespace {

/// The sentence of the error that running the shader throws.
std::string error_of(rhi::Device& device, const std::string& glsl, rhi::ErrorCode code) {
  try {
    run(device, glsl, Words(64), 4);
  } catch (const rhi::Error& error) {
    CHECK(error.code() == code);
    return error.what();
  }
  return "";
}

TEST_CASE("barriers in loops and functions order what invocations write to shared memory") {
  const rhi::DeviceHandle device = device_with(8);
  const std::uint32_t n = 96;
  const Words words = run(*device, R"(
layout(local_size_x = 12, local_size_y = 4, local_size_z = 2) in;
layout(binding = 0) buffer B { uint b[]; };
struct Pair { uint sum; uvec2 both[2]; bool seen; };
shared uint values[96];
shared Pair pair;
shared uint order;
uint scan(uint x) {
  uint i = gl_LocalInvocationIndex;
  values[i] = x;
  barrier();
  for (uint step = 1; step < 96; step *= 2) {
    uint left = i >= step ? values[i - step] : 0;
    barrier();
    values[i] += left;
    barrier();
  }
  return values[i];
}
void raise(inout uint x) { x += 1000; }
void main() {
  uint i = gl_LocalInvocationIndex, group = gl_WorkGroupID.x;
  uint untouched = uint(pair.seen) + pair.sum + pair.both[1].y;  // of no workgroup before
  barrier();
  uint result = scan(i + group);
  if (i == 95) {
    pair.both[group & 1].y = result;
    pair.seen = true;
  }
  barrier();
  atomicAdd(pair.sum, i);
  atomicMax(pair.both[1].x, i * 2);
  barrier();
  if (i == 0) raise(pair.sum);
  uint x = 0;
  do {
    barrier();
    x += pair.seen ? pair.both[group & 1].y : 0;
  } while (x < 3 * (4560 + 96 * group));
  b[group * 96 + i] = result * 7 + pair.sum + pair.both[1].x + x + untouched;
}
)",
                          Words(3 * n), 3);
  Words expected;
  for (std::uint32_t group = 0; group < 3; ++group)
    for (std::uint32_t i = 0; i < n; ++i)
      expected.push_back(((i + 1) * i / 2 + group * (i + 1)) * 7 + 4560 + 1000 + 190 + 3 * (4560 + 96 * group));
  CHECK(words == expected);
}

TEST_CASE("a workgroup has up to 1024 invocations, and its memory is its own") {
  const rhi::DeviceHandle device = device_with(8);
  const Words words = run(*device, R"(
layout(local_size_x = 1024) in;
layout(binding = 0) buffer B { uint b[]; };
shared uint values[16384];
void main() {
  uint i = gl_LocalInvocationIndex;
  for (uint k = 0; k < 16; ++k) values[k * 1024 + i] += i * k + gl_WorkGroupID.x;
  barrier();
  uint sum = 0;
  for (uint k = 0; k < 16; ++k) sum += values[k * 1024 + (i + 513) % 1024];
  b[gl_GlobalInvocationID.x] = sum;
}
)",
                          Words(64 * 1024), 64);
  for (std::uint32_t i = 0; i < words.size(); ++i) REQUIRE(words[i] == (i + 513) % 1024 * 120 + 16 * (i / 1024));
}

TEST_CASE("what no shader may do to a barrier ends the launch with a sentence") {
  const rhi::DeviceHandle device = device_with(8);
  const std::string head = "layout(local_size_x = 32) in;\nlayout(binding = 0) buffer B { uint b[]; };\n";
  const std::string sentence = "groups: some invocations of a workgroup reach a barrier() that others do not reach";
  const auto invalid = rhi::ErrorCode::invalid_argument;
  const std::string returns = head + "void main() { if (gl_LocalInvocationIndex == 7) return; barrier(); b[0] = 1; }";
  CHECK(error_of(*device, returns, invalid) == sentence);
  const std::string others = head + R"(
void main() {
  if (gl_LocalInvocationIndex < 9 + b[0]) { b[1] = 2; barrier(); } else { b[1] = 3; barrier(); b[2] = b[1]; }
})";
  CHECK(error_of(*device, others, invalid) == sentence);
  const std::string loops = "#extension GL_KHR_shader_subgroup_basic : require\n" + head + R"(
void main() { for (uint i = 0; i < gl_LocalInvocationIndex; ++i) { barrier(); b[0] = uint(subgroupElect()); } })";
  CHECK(error_of(*device, loops, invalid) == sentence);
  const std::string large = head + "shared uint s[16385]; void main() { s[b[0]] = 1; b[1] = s[b[2]]; }";
  CHECK(error_of(*device, large, rhi::ErrorCode::unsupported) ==
        "groups: its shared variables have 65540 bytes, where a workgroup on the CPU device has 65536");
  // The device is as usable as before.
  CHECK(run(*device, head + "void main() { barrier(); b[gl_LocalInvocationIndex] = 5; }", Words(32)) == Words(32, 5));
}

TEST_CASE("a time limit ends what fibres do") {
  rhi::DeviceDesc desc;
  desc.time_limit = std::chrono::milliseconds(50);
  const rhi::DeviceHandle device = create_device(desc, {});
  const std::string loop = R"(
layout(local_size_x = 64) in;
layout(binding = 0) buffer B { uint b[]; };
shared uint s;
void main() {
  barrier();
  if (gl_LocalInvocationIndex == 40) while (b[0] == 0) { atomicAdd(s, 1); }
  barrier();
  b[gl_LocalInvocationIndex] += s + 1;
}
)";
  CHECK(error_of(*device, loop, rhi::ErrorCode::timeout).find("groups: it ran for more than the 50 ms") == 0);
  CHECK(run(*device, loop, Words(64, 1)) == Words(64, 2));
}

TEST_CASE("an index outside of a shared array is one inside of it") {
  const rhi::DeviceHandle device = device_with(8);
  const Words words = run(*device, R"(
layout(local_size_x = 16) in;
layout(binding = 0) buffer B { uint b[]; };
shared uint s[16];
void main() {
  uint i = gl_LocalInvocationIndex;
  if (b[i] < 16u || i == 3) s[b[i]] = i + 1;
  barrier();
  b[i] = s[i] + s[b[4] + 123456789];
}
)",
                          {15, 14, 13, 0xfffffff0, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 12});
  Words expected;
  for (std::uint32_t i = 0; i < 16; ++i) expected.push_back(4 + (i == 0 ? 4 : i == 12 ? 16 : 16 - i));
  CHECK(words == expected);
}

}  // namespace
}  // namespace tandem::cpu::test
