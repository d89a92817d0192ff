// Buffer references: in push constants, buffers, structures, arrays, functions and loops; as integers; null.

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "rhi_cpu/kernel/shader_call.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::test::Kernel;
using tandem::test::KernelOptions;
using tandem::test::resource;

template <typename T>
std::uint64_t address_of(const T& values) {
  return reinterpret_cast<std::uintptr_t>(values.data());
}

constexpr const char* extensions = R"(
    #extension GL_EXT_buffer_reference : require
    #extension GL_EXT_buffer_reference2 : require
    #extension GL_EXT_buffer_reference_uvec2 : require
    #extension GL_EXT_scalar_block_layout : require
    #extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
)";

TEST_CASE("references are followed through constants, buffers, structures, arrays and functions") {
  const std::string source = std::string(extensions) + R"(
    layout(local_size_x = 1) in;
    layout(buffer_reference, std430) buffer Floats { float values[]; };
    layout(buffer_reference, scalar) buffer Mesh { vec3 corner; mat2x3 turn; Floats weights; vec3 more[]; };
    layout(buffer_reference, std430, buffer_reference_align = 4) buffer One { float value; };
    struct Pair { int which; Floats both[2]; };
    layout(push_constant, scalar) uniform Constants { Mesh mesh; int n; uint64_t number; };
    layout(std430, binding = 0) buffer Table { Pair pairs[]; };
    layout(std430, binding = 1) buffer Result { float result[]; };
    float first(Floats f) { return f.values[0]; }
    Floats pick(Pair p, bool one) { return one ? p.both[1] : p.both[0]; }
    void add(Floats f, float x) { f.values[1] += x; }
    void main() {
      result[0] = mesh.corner.y; result[1] = mesh.turn[1].z; result[2] = mesh.more[n].x;
      result[3] = mesh.weights.values[n];
      Pair pair = pairs[n];
      result[4] = first(pair.both[pair.which]); result[5] = pick(pair, n == 1).values[1];
      add(pair.both[0], 100.0);
      Floats f = Floats(number);
      result[6] = f.values[2];
      result[7] = Floats(number + 4ul).values[0];
      result[8] = float(uint64_t(f) == number);
      uvec2 words = uvec2(f);
      result[9] = Floats(words).values[1];
      One one = One(number);
      result[10] = one[n + 1].value + (one + 1).value;
      Floats nothing = Floats(0ul);
      result[11] = float(uint64_t(nothing) == 0ul);
      mesh.more[0] = vec3(7, 8, 9);
      Mesh copy = mesh;
      copy.weights = pair.both[1];
      pairs[0].both[n] = f;
      pairs[0].which = 44;
      float sum = 0.0;
      for (int i = 0; i < 3; ++i) { f = i == 1 ? pair.both[0] : pair.both[1]; sum += f.values[0]; }
      result[12] = sum;
    })";
  // Not optimised: spirv-opt makes variables out of arrays of references without the decoration that they must have.
  const Kernel kernel(source);
  CHECK(kernel.info().push_constant_size == 24);
  std::vector<float> weights = {1, 2}, left = {10, 11, 12}, right = {20, 21, 22};
  // corner at 0, turn at 12 (columns of 12 bytes), weights at 40, more at 48
  std::vector<float> mesh = {1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0, 0, 0, 0, 0, 5.5f, 0, 0};
  const std::uint64_t weights_address = address_of(weights);
  std::memcpy(&mesh[10], &weights_address, 8);
  struct Pair {
    std::int32_t which;
    std::uint64_t both[2];
  };
  std::vector<Pair> pairs = {{0, {0, 0}}, {1, {address_of(left), address_of(right)}}};
  struct {
    std::uint64_t mesh;
    std::int32_t n;
    std::uint32_t unused;
    std::uint64_t number;
  } constants = {address_of(mesh), 1, 0, address_of(left)};
  std::vector<float> result(13, -1);
  kernel.run({resource(pairs), resource(result)}, {1}, std::as_bytes(std::span(&constants, 1)));
  CHECK(result == std::vector<float>{2, 9, 5.5f, 2, 20, 21, 12, 111, 1, 111, 123, 1, 50});
  CHECK(left[1] == 111);
  CHECK(mesh[12] == 7);
  CHECK(mesh[14] == 9);
  std::uint64_t replaced;
  std::memcpy(&replaced, &mesh[10], 8);
  CHECK(replaced == address_of(right));
  CHECK(pairs[0].both[1] == address_of(left));
  CHECK(pairs[0].which == 44);
}

TEST_CASE("a list whose nodes refer to nodes, and atomic operations behind a reference") {
  const std::string source = std::string(extensions) + R"(
    layout(local_size_x = 4) in;
    layout(buffer_reference) buffer Node;
    layout(buffer_reference, std430, buffer_reference_align = 8) buffer Node { Node next; int value; uint visits; };
    layout(push_constant) uniform Constants { Node head; };
    layout(std430, binding = 0) buffer Result { int result[4]; };
    void main() {
      int sum = 0;
      Node node = head;
      while (uint64_t(node) != 0ul) { sum += node.value; atomicAdd(node.visits, 1u); node = node.next; }
      result[gl_LocalInvocationIndex] = sum;
    })";
  struct Node {
    const Node* next;
    std::int32_t value;
    std::uint32_t visits;
  };
  for (const bool optimize : {false, true}) {
    CAPTURE(optimize);
    KernelOptions options;
    options.optimize = optimize;
    const Kernel kernel(source, options);
    Node third = {nullptr, 100, 0}, second = {&third, 20, 0}, first = {&second, 3, 0};
    const Node* const head = &first;
    std::vector<std::int32_t> result(4);
    kernel.run({resource(result)}, {1}, std::as_bytes(std::span(&head, 1)));
    CHECK(result == std::vector<std::int32_t>{123, 123, 123, 123});
    CHECK(first.visits == 4);
    CHECK(third.visits == 4);
  }
}

TEST_CASE("references in shader records and payloads") {
  namespace kernel = tandem::kernel;
  const std::vector<std::uint32_t> spirv = tandem::test::traced_spirv(std::string(extensions) + R"(
    layout(buffer_reference, std430) buffer Floats { float values[]; };
    layout(shaderRecordEXT, scalar) buffer Record { float scale; Floats source; };
    struct Payload { bool found; Floats target; };
    layout(location = 0) rayPayloadInEXT Payload payload;
    void main() { payload.target.values[1] = scale * source.values[2]; payload.found = true; payload.target = source; }
  )",
                                                                      tandem::rhi::ShaderStage::miss);
  const Kernel shader(spirv, {});
  CHECK(shader.info().shader_record_size == 16);
  std::vector<float> source = {1, 2, 3}, target = {0, 0};
  struct {
    float scale;
    std::uint32_t unused;
    std::uint64_t source;
  } record = {10, 0, address_of(source)};
  struct {
    bool found;
    std::uint64_t target;
  } payload = {false, address_of(target)};
  CHECK(shader.info().payload_size == sizeof(payload));
  kernel::ShaderCall call;
  call.shader_record = reinterpret_cast<const std::byte*>(&record);
  call.payload = &payload;
  shader.call(call);
  CHECK(target[1] == 30);
  CHECK(payload.found);
  CHECK(payload.target == address_of(source));
}

}  // namespace
