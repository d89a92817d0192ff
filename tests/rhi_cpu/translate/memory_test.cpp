// Buffers, push constants, arrays of buffers, atomics.

#include <cstdint>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::kernel::Dispatch;
using tandem::kernel::Resource;
using tandem::kernel::ResourceKind;
using tandem::test::Kernel;
using tandem::test::resource;

TEST_CASE("a kernel says where its bindings lie, and reads arrays of buffers with any index") {
  const Kernel kernel(R"(
    layout(local_size_x = 1) in;
    layout(set = 1, binding = 4, std430) readonly buffer Many { int first; int rest[]; } many[3];
    layout(set = 0, binding = 2, std140) uniform Which { int index; } which[2];
    layout(set = 0, binding = 7, std430) buffer Result { int result[]; };
    void main() {
      int n = which[1].index;
      result[0] = many[n].first;
      result[1] = many[n].rest[n];
      result[2] = int(many[n].rest.length());
      result[3] = int(many[0].rest.length()) + which[n - 2].index;
      result[4] = result.length();
    })");
  const tandem::kernel::KernelInfo& info = kernel.info();
  CHECK(info.abi_version == tandem::kernel::abi_version);
  REQUIRE(info.binding_count == 3);
  CHECK(info.resource_count == 6);
  CHECK(info.push_constant_size == 0);
  const tandem::kernel::BindingSlot expected[] = {{0, 2, 2, 0, ResourceKind::uniform_buffer},
                                                  {0, 7, 1, 2, ResourceKind::storage_buffer},
                                                  {1, 4, 3, 3, ResourceKind::storage_buffer}};
  for (int i = 0; i < 3; ++i) {
    CHECK(info.bindings[i].set == expected[i].set);
    CHECK(info.bindings[i].binding == expected[i].binding);
    CHECK(info.bindings[i].count == expected[i].count);
    CHECK(info.bindings[i].first_resource == expected[i].first_resource);
    CHECK(info.bindings[i].kind == expected[i].kind);
  }
  std::vector<std::int32_t> which0 = {50}, which1 = {2}, result(5), a = {1}, b = {2, 3}, c = {4, 5, 6, 7};
  kernel.run({resource(which0), resource(which1), resource(result), resource(a), resource(b), resource(c)});
  CHECK(result == std::vector<std::int32_t>{4, 7, 3, 50, 5});
}

TEST_CASE("whole structs and runtime arrays of structs") {
  const Kernel kernel(R"(
    layout(local_size_x = 1) in;
    struct Inner { vec3 v; float f; };
    struct Item { int id; Inner inner[2]; uvec2 pair; };
    layout(std430, binding = 0) buffer Items { uint count; Item items[]; };
    layout(push_constant, std430) uniform Push { vec3 shift; int from; ivec2 ends[2]; } push;
    void main() {
      Item item = items[push.from];
      item.inner[1].v += push.shift;
      item.pair = uvec2(push.ends[1].y, items.length());
      items[count] = item;
      items[0].inner[0] = item.inner[1];
    })");
  CHECK(kernel.info().push_constant_size == 32);
  // Item: id at 0, inner at 16 (two of 16 bytes), pair at 48, stride 64; items at 16.
  std::vector<float> memory(4 + 16 * 3, 0.0f);
  memory[0] = std::bit_cast<float>(2u);
  float* const one = &memory[4 + 16];
  one[0] = std::bit_cast<float>(77);
  for (int i = 4; i < 12; ++i) one[i] = static_cast<float>(i);
  struct {
    float shift[3] = {10, 20, 30};
    std::int32_t from = 1;
    std::int32_t ends[4] = {1, 2, 3, 99};
  } push;
  kernel.run({resource(memory)}, {1}, std::as_bytes(std::span(&push, 1)));
  const float* const two = &memory[4 + 32];
  CHECK(std::bit_cast<std::int32_t>(two[0]) == 77);
  CHECK(std::vector<float>(two + 4, two + 12) == std::vector<float>{4, 5, 6, 7, 18, 29, 40, 11});
  CHECK(std::bit_cast<std::uint32_t>(two[12]) == 99);
  CHECK(std::bit_cast<std::uint32_t>(two[13]) == 3);
  CHECK(std::vector<float>(&memory[8], &memory[12]) == std::vector<float>{18, 29, 40, 11});
}

TEST_CASE("atomics are atomic across threads") {
  const Kernel kernel(R"(
    #extension GL_EXT_shader_atomic_float : require
    layout(local_size_x = 64) in;
    layout(std430, binding = 0) buffer Result { uint sum; int least; uint most; uint any_bits; uint odd; uint tickets; float total; uint count; };
    void main() {
      uint i = gl_GlobalInvocationID.x;
      atomicAdd(sum, i);
      atomicMin(least, 5 - int(i));
      atomicMax(most, i * 3u);
      atomicOr(any_bits, 1u << (i % 20u));
      atomicXor(odd, i);
      atomicAdd(total, 0.5);
      uint expected, found = tickets;
      do {
        expected = found;
        found = atomicCompSwap(tickets, expected, expected + 2u);
      } while (found != expected);
      if (atomicExchange(count, i) == 0xffffffffu) atomicAnd(odd, 0xffffffffu);
    })");
  constexpr std::uint32_t groups = 256, threads = 4, invocations = 64 * groups;
  std::vector<std::uint32_t> result(8, 0);
  result[7] = 0xffffffffu;
  const Resource only = resource(result);
  Dispatch dispatch;
  dispatch.resources = &only;
  dispatch.workgroup_count[0] = groups;
  {
    std::vector<std::jthread> pool;
    for (std::uint32_t t = 0; t < threads; ++t)
      pool.emplace_back([&, t] { kernel.info().run(dispatch, t * groups / threads, (t + 1) * groups / threads); });
  }
  std::uint32_t odd = 0;
  for (std::uint32_t i = 0; i < invocations; ++i) odd ^= i;
  CHECK(result[0] == invocations * (invocations - 1) / 2);
  CHECK(static_cast<std::int32_t>(result[1]) == 5 - static_cast<std::int32_t>(invocations - 1));
  CHECK(result[2] == 3 * (invocations - 1));
  CHECK(result[3] == (1u << 20) - 1);
  CHECK(result[4] == odd);
  CHECK(result[5] == 2 * invocations);
  CHECK(std::bit_cast<float>(result[6]) == 0.5f * invocations);
}

}  // namespace
