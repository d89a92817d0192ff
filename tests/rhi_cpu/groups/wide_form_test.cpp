// The wide form of a kernel gives the bits of the scalar form.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "rhi/glsl/compile.hpp"
#include "rhi/transfer.hpp"
#include "rhi_cpu/device.hpp"
#include "tests/rhi_cpu/groups/device.hpp"

namespace tandem::cpu::test {
namespace {

Words run_with(std::uint32_t lanes, const std::string& glsl, const Words& words, std::uint32_t workgroups) {
  rhi::DeviceDesc desc;
  desc.lanes = lanes;
  return run(*create_device(desc, {}), glsl, words, workgroups);
}

void check_forms(const std::string& glsl, const Words& words, std::uint32_t workgroups) {
  const Words expected = run_with(1, glsl, words, workgroups);
  for (const std::uint32_t lanes : {4u, 8u, 16u}) {
    CAPTURE(lanes);
    const Words found = run_with(lanes, glsl, words, workgroups);
    std::size_t differences = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (found[i] == expected[i]) continue;
      if (differences++ < 3) MESSAGE(fmt::format("word {}: {:#x} instead of {:#x}", i, found[i], expected[i]));
    }
    CHECK(differences == 0);
  }
}

TEST_CASE("halves of the wide form have the bits of the scalar form") {
  // The lower half of a word is x, the upper one y; all x occur.
  const std::string glsl = R"(
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 64) in;
layout(binding = 0) buffer B { uint b[]; };
uint hash;
void add(uint bits) { hash = (hash ^ bits) * 0x01000193u; hash ^= hash >> 15; }
void add(float16_t value) { add(value == value ? uint(float16BitsToUint16(value)) : 0x7e00u); }
void add(bool value) { add(uint(value)); }
void main() {
  uint i = gl_GlobalInvocationID.x;
  float16_t x = uint16BitsToFloat16(uint16_t(b[i])), y = uint16BitsToFloat16(uint16_t(b[i] >> 16));
  float16_t one = float16_t(1), half_of_one = float16_t(0.5);
  hash = 0;
  add(x + y);
  add(x - y);
  add(x * y);
  add(x / y);
  add(-x);
  add(x == y);
  add(x != y);
  add(x < y);
  add(x <= y);
  add(x > y);
  add(x >= y);
  add(min(x, y));
  add(max(x, y));
  add(clamp(x, y, one));
  add(abs(x));
  add(sign(x));
  add(floor(x));
  add(ceil(x));
  add(trunc(x));
  add(fract(x));
  add(mod(x, y));
  add(mix(x, y, half_of_one));
  add(step(x, y));
  add(smoothstep(x, y, half_of_one));
  add(sqrt(x));
  add(isinf(x));
  add(float16_t(float(x) * 1.001));
  add(float16_t(double(x) * 1.001));
  add(x == x ? floatBitsToUint(float(x)) : 0u);
  if (abs(x) < float16_t(60000)) {
    add(uint(int(x)));
    add(uint(abs(x)));
    add(float16_t(int(x)));
  }
  f16vec3 v = f16vec3(x, y, half_of_one), w = v.zxy;
  add(dot(v, w));
  add(length(v * float16_t(0.125)));
  add(cross(v, w).y);
  add((v + w * one).x);
  v /= w;
  v[i % 3u] += one;
  add(v.z);
  add((f16mat2(x, y, one, half_of_one) * v.xy).y);
  add(any(lessThan(v, w)));
  add((vec3(v) * 3.0).x < 1.0);
  add(f16vec2(vec2(0.1, 0.2) * float(y)).y);
  b[i] = hash;
}
)";
  constexpr std::uint32_t halves = 65536;
  Words words(halves);
  for (std::uint32_t i = 0; i < halves; ++i) words[i] = i | ((i * 0x9e3779b1u) & 0xffff0000u);
  check_forms(glsl, words, halves / 64);
}

TEST_CASE("a negative fraction becomes the integer 0, and that the float +0") {
  const std::string glsl = R"(
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 16) in;
layout(binding = 0) buffer B { uint b[]; };
void main() {
  uint i = gl_LocalInvocationIndex;
  float x = uintBitsToFloat(b[i]);
  uint all_bits = floatBitsToUint(float(int(x))) | floatBitsToUint(float(uint(x))) |
                  floatBitsToUint(vec2(ivec2(x)).y) | floatBitsToUint(float(int64_t(x)));
  b[i] = all_bits | unpackDouble2x32(double(int(double(x)))).y;
}
)";
  const Words zeros(16);
  for (const std::uint32_t lanes : {1u, 16u}) CHECK(run_with(lanes, glsl, Words(16, 0xbf000000u), 1) == zeros);
}

TEST_CASE("functions that are too much to inline take values") {
  std::string glsl = "layout(local_size_x = 16) in;\nlayout(binding = 0) buffer B { uint b[]; };\n";
  glsl += "uint f0(const uint x, const uint y) { return x * 3u + y; }\n";
  constexpr int depth = 12;
  for (int i = 1; i <= depth; ++i)
    glsl +=
        fmt::format("uint f{0}(const uint x, const uint y) {{ return f{1}(x, y) ^ f{1}(y, x + {0}u); }}\n", i, i - 1);
  glsl += fmt::format("void main() {{ uint i = gl_GlobalInvocationID.x; b[i] = f{}(b[i], 7u); }}\n", depth);
  check_forms(glsl, {0, 1, 2, 3, 5, 8, 13, 21, 34, 55, 89, 144, 233, 377, 610, 987}, 1);
}

TEST_CASE("the index of a member is not taken for the id of a variable") {
  // glslang numbers gl_LocalInvocationIndex among the indices of the array.
  std::string glsl = R"(
layout(local_size_x = 16) in;
layout(binding = 0) buffer B { uint b[]; };
struct S { uint words[80]; };
layout(binding = 0) buffer C { S structs[]; };
void main() {
  uint at = gl_LocalInvocationIndex;
  S s = structs[gl_WorkGroupID.x];
  uint sum = 0u;
)";
  for (int i = 0; i < 80; ++i) glsl += fmt::format("  sum += s.words[{}] * {}u;\n", i, i + 1);
  glsl += "  b[80u + at] = sum + at;\n}\n";
  Words words(96);
  for (std::uint32_t i = 0; i < 80; ++i) words[i] = i * i;
  check_forms(glsl, words, 1);
}

TEST_CASE("elements of shared arrays, next to each other, the same, and in any order") {
  const std::string glsl = R"(
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0) buffer B { uint b[]; };
shared uint line[64];
shared float square[4][16];
shared vec3 vectors[64];
shared double doubles[64];
shared uint8_t bytes[64];
shared struct { uint words[64]; } inside;
uint of(uint at, bool twice) { return line[at] * (twice ? 2u : 1u); }
void main() {
  uint i = gl_LocalInvocationIndex, x = gl_LocalInvocationID.x, y = gl_LocalInvocationID.y, mine = b[i];
  line[i] = mine;
  square[y][x] = float(mine % 1000u);
  vectors[63u - i].y = float(i);
  vectors[i].x = 0.5;
  doubles[i ^ 5u] = double(mine);
  bytes[i] = uint8_t(mine);
  inside.words[i] = ~mine;
  barrier();
  uint sum = line[63u - i] * 3u + line[(i + 1u) & 63u] * 5u + line[mine & 63u] * 7u + line[b[64] & 63u];
  if (i % 3u != 0u) sum += of(i, mine > 7u);
  for (uint k = 0u; k < (i & 3u); ++k) sum = sum * 31u + line[(i + k) & 63u];
  float all = 0.0;
  for (int k = 0; k < 16; ++k) all += square[y][k] * square[k & 3][x];
  sum += uint(all) + uint(vectors[i].y + vectors[mine & 63u].x * 64.0) + uint(doubles[i]) + uint(bytes[i ^ 1u]);
  sum ^= inside.words[(i * 7u) & 63u];
  barrier();
  line[mine & 15u] = i;
  if ((mine & 16u) != 0u && i < 48u) line[16u + i] = sum;
  barrier();
  b[i] = sum;
  b[65u + i] = line[i];
}
)";
  Words words(129);
  for (std::uint32_t i = 0; i < words.size(); ++i) words[i] = i * 0x9e3779b1u >> 7;
  // Two invocations of a subgroup write one element, of which the last one stays; those of others come as they come.
  for (std::uint32_t i = 0; i < 64; ++i) words[i] = (words[i] & ~15u) | (i / 8 * 2 + i % 2);
  check_forms(glsl, words, 1);
}

TEST_CASE("pointers that differ between invocations are values") {
  const std::string glsl = R"(#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
layout(local_size_x = 16) in;
layout(buffer_reference) buffer Node;
layout(buffer_reference, buffer_reference_align = 8) buffer Node { uint value; uint more; Node next; };
layout(binding = 0) buffer B { uint64_t start; uint64_t unused; uint b[]; };
uint sum(Node node, uint count) {
  uint result = 0u;
  for (uint k = 0u; k < count; ++k) {
    result = result * 3u + node.value;
    if (node.value == 5u) return result;
    node = node.next;
  }
  return result;
}
Node chosen(bool condition, Node a, Node c) {
  if (condition) return a;
  return c;
}
void main() {
  uint i = gl_LocalInvocationIndex;
  Node mine = Node(start + 16u + 128u + i * 16u), first = Node(start + 16u + 128u);
  mine.value = i;
  mine.more = 100u + i;
  mine.next = Node(start + 16u + 128u + ((i * 5u + 1u) % 16u) * 16u);
  barrier();
  Node other = i > 7u ? mine.next : chosen(i % 3u == 0u, mine, first);
  b[i] = sum(mine, i) ^ (other.more << 20) ^ uint(uint64_t(other) - start);
  uvec2 halves = uvec2(other);
  b[16u + i] = (halves.x - uvec2(mine).x) + Node(halves).value;
}
)";
  constexpr std::size_t count = 4 + 32 + 64;
  std::vector<Words> results;
  for (const std::uint32_t lanes : {1u, 4u, 8u, 16u}) {
    rhi::DeviceDesc desc;
    desc.lanes = lanes;
    const rhi::DeviceHandle device = create_device(desc, {});
    const rhi::ComputePipelineHandle pipeline = device->create_compute_pipeline(
        {.shader = device->create_shader_module(
             {.spirv = glsl::compile(glsl, rhi::ShaderStage::compute, "pointers.comp"), .label = "pointers"}),
         .specialization = {},
         .label = "pointers"});
    const rhi::BufferHandle buffer = device->create_buffer(
        {.size = count * 4, .usage = rhi::BufferUsage::storage | rhi::BufferUsage::device_address, .label = "nodes"});
    // As two words, relative to which the results are the same in every run.
    Words words(count);
    const std::uint64_t address = buffer->device_address();
    words[0] = static_cast<std::uint32_t>(address);
    words[1] = static_cast<std::uint32_t>(address >> 32);
    const rhi::CommandListHandle list = device->create_command_list("pointers");
    list->upload(buffer, 0, std::as_bytes(std::span(words)));
    rhi::BindGroupDesc bindings;
    bindings.pipeline = pipeline;
    bindings.entries.push_back({.binding = 0, .resource = rhi::BufferRange{buffer}});
    bindings.label = "pointers";
    list->dispatch({.pipeline = pipeline, .bind_groups = {device->create_bind_group(bindings)}});
    device->submit(list);
    const Words found = rhi::read<std::uint32_t>(*device, buffer, count);
    results.emplace_back(found.begin() + 4, found.begin() + 4 + 32);
    CHECK(results.back() == results.front());
  }
  CHECK(results.front()[2] != 0);
}

TEST_CASE("a texture that differs between invocations is sampled by each") {
  const std::string glsl = R"(#version 460
#extension GL_EXT_nonuniform_qualifier : require
layout(local_size_x = 16) in;
layout(binding = 0) buffer B { float b[]; };
layout(binding = 1) uniform texture2D textures[2];
layout(binding = 2) uniform sampler s;
layout(binding = 3) uniform sampler2D combined[2];
void main() {
  uint i = gl_LocalInvocationIndex, k = i % 2u;
  vec2 at = vec2(0.5);
  b[i] = texture(nonuniformEXT(sampler2D(textures[k], s)), at).x;
  b[i] += 10.0 * texture(sampler2D(textures[nonuniformEXT(1u - k)], s), at).x;
  if (i > 3u) b[i] += 100.0 * texture(combined[nonuniformEXT(k)], at).x;
  b[i] += 1000.0 * textureLod(nonuniformEXT(combined[k]), at, 0.0).x;
}
)";
  const rhi::DeviceHandle device = create_device({}, {});
  const rhi::ComputePipelineHandle pipeline = device->create_compute_pipeline(
      {.shader = device->create_shader_module(
           {.spirv = glsl::compile(glsl, rhi::ShaderStage::compute, "textures.comp"), .label = "textures"}),
       .specialization = {},
       .label = "textures"});
  constexpr std::size_t count = 16;
  const rhi::BufferHandle buffer =
      rhi::create_filled(*device, std::vector<float>(count), rhi::BufferUsage::storage, "floats");
  rhi::BindGroupDesc bindings;
  bindings.pipeline = pipeline;
  bindings.label = "textures";
  const rhi::SamplerHandle sampler = device->create_sampler({.label = "sampler"});
  bindings.entries = {{.binding = 0, .resource = rhi::BufferRange{buffer}}, {.binding = 2, .resource = sampler}};
  for (const std::uint32_t k : {0u, 1u}) {
    const rhi::TextureHandle texture =
        rhi::create_filled(*device, std::vector<float>{static_cast<float>(k + 1)},
                           rhi::TextureDesc{.format = rhi::TextureFormat::r32_float, .label = "texture"});
    bindings.entries.push_back({.binding = 1, .resource = rhi::TextureView{texture}, .array_element = k});
    bindings.entries.push_back({.binding = 3, .resource = rhi::SampledTexture{{texture}, sampler}, .array_element = k});
  }
  const rhi::CommandListHandle list = device->create_command_list("textures");
  list->dispatch({.pipeline = pipeline, .bind_groups = {device->create_bind_group(bindings)}});
  device->submit(list);
  std::vector<float> expected;
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_odd = i % 2 == 1;
    const float own = is_odd ? 2.0f : 1.0f, other = is_odd ? 1.0f : 2.0f;
    expected.push_back(own + 10.0f * other + (i > 3 ? 100.0f * own : 0.0f) + 1000.0f * own);
  }
  CHECK(rhi::read<float>(*device, buffer, count) == expected);
}

}  // namespace
}  // namespace tandem::cpu::test
