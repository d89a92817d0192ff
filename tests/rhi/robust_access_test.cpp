#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "rhi/transfer.hpp"
#include "tests/rhi/dispatch.hpp"

using namespace tandem;

// What lies outside of what is bound reads as zero and is not written: Vulkan's robustBufferAccess2 and
// robustImageAccess2, on every device.

namespace {

using Words = std::vector<std::uint32_t>;

/// The `count` words that a shader leaves at binding 0, with these other entries.
Words answers(rhi::Device& device, const std::string& glsl, std::size_t count, std::vector<rhi::BindGroupEntry> entries,
              const Words& push_constants = {}) {
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, "#version 460\n" + glsl, "robust");
  const rhi::BufferHandle buffer = test::buffer_of(device, Words(count, 7), "answers");
  entries.push_back({.binding = 0, .resource = rhi::BufferRange{buffer}});
  const rhi::CommandListHandle list = device.create_command_list("robust");
  list->dispatch(
      {.pipeline = pipeline,
       .bind_groups = {device.create_bind_group({.pipeline = pipeline, .entries = entries, .label = "group"})},
       .push_constants = std::as_bytes(std::span(push_constants))});
  device.submit(list)->wait();
  return test::contents<std::uint32_t>(device, buffer, count);
}

}  // namespace

TANDEM_DEVICE_TEST("loads outside of a bound range are zero, stores and atomics do nothing") {
  // 64 words, of which 4 are bound.
  const rhi::BufferHandle words = test::buffer_of(device, Words(64, 5), "words");
  const rhi::BufferRange bound = {words, 0, 16};
  const Words seen = answers(device, R"(
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { uint answers[8]; };
layout(binding = 1) buffer Source { uint source[]; };
layout(push_constant) uniform Constants { int far; int before; int next; };
void main() {
  answers[0] = source[3];
  answers[1] = source[next];
  answers[2] = source[far];
  answers[3] = source[before];
  source[next] = 1;
  source[far] = 2;
  source[before] = 3;
  answers[4] = atomicAdd(source[far], 1);
  source[2] = 9;
  answers[5] = uint(source.length());
})",
                             6, {{.binding = 1, .resource = bound}}, {0x3fffffff, 0xffffffff, 4});
  CHECK(seen == Words{5, 0, 0, 0, 0, 4});
  Words expected(64, 5);
  expected[2] = 9;
  CHECK(test::contents<std::uint32_t>(device, words, 64) == expected);
}

TANDEM_DEVICE_TEST("structures, matrices and uniform blocks are checked as words are") {
  const rhi::BufferHandle words = test::buffer_of(device, Words(16, 0x3f800000), "words");
  const Words seen = answers(
      device, R"(
layout(local_size_x = 1) in;
struct Item { vec4 a; mat2 b; };
layout(binding = 0) buffer Answers { uint answers[4]; };
layout(binding = 1) buffer Items { Item items[]; };
layout(binding = 2) uniform Block { vec4 vectors[16]; };
layout(push_constant) uniform Constants { uint index; };
void main() {
  Item item = items[index];
  answers[0] = uint(items[0].a.x + items[0].b[1].x);
  answers[1] = uint(item.a.x + item.b[0].x);
  items[index] = Item(vec4(2), mat2(2));
  answers[2] = uint(vectors[index + 3].x);
  answers[3] = uint(vectors[index - 4].y);
})",
      4, {{.binding = 1, .resource = rhi::BufferRange{words}}, {.binding = 2, .resource = rhi::BufferRange{words}}},
      {4});
  CHECK(seen == Words{2, 0, 0, 1});
  CHECK(test::contents<std::uint32_t>(device, words, 16) == Words(16, 0x3f800000));
}

TANDEM_DEVICE_TEST("texels outside of an image are zero and not written") {
  const rhi::TextureHandle image = rhi::create_filled(
      device, Words(4, 5), {.format = rhi::TextureFormat::r32_uint, .size = {2, 2, 1}, .label = "i"});
  const Words seen = answers(device, R"(
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { uint answers[3]; };
layout(binding = 1, r32ui) uniform uimage2D image;
layout(push_constant) uniform Constants { int x; };
void main() {
  answers[0] = imageLoad(image, ivec2(1, 1)).x;
  answers[1] = imageLoad(image, ivec2(x, 0)).x;
  answers[2] = imageLoad(image, ivec2(0, -x)).x;
  imageStore(image, ivec2(x, 0), uvec4(1));
})",
                             3, {{.binding = 1, .resource = image}}, {2});
  CHECK(seen == Words{5, 0, 0});
  const std::vector<std::byte> bytes = rhi::read(device, image);
  CHECK(std::vector<std::byte>{bytes[0], bytes[4], bytes[8], bytes[12]} == std::vector<std::byte>(4, std::byte{5}));
}

TANDEM_DEVICE_TEST("what lies outside of an image has the alpha of its format") {
  const auto texture = [&](rhi::TextureFormat format) {
    return device.create_texture({.format = format, .size = {2, 2, 1}, .label = "texels"});
  };
  const rhi::SamplerHandle sampler = device.create_sampler({.label = "nearest"});
  rhi::SampledTexture sampled;
  sampled.view.texture = texture(rhi::TextureFormat::rg16_float);
  sampled.sampler = sampler;
  const Words seen = answers(device, R"(
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { vec4 answers[3]; };
layout(binding = 1, r32f) uniform image2D one;
layout(binding = 2, rgba8) uniform image2D four;
layout(binding = 3) uniform sampler2D two;
layout(push_constant) uniform Constants { int x; };
void main() {
  answers[0] = imageLoad(one, ivec2(x, 0));
  answers[1] = imageLoad(four, ivec2(0, x));
  answers[2] = texelFetch(two, ivec2(x, 0), 0);
})",
                             12,
                             {{.binding = 1, .resource = texture(rhi::TextureFormat::r32_float)},
                              {.binding = 2, .resource = texture(rhi::TextureFormat::rgba8_unorm)},
                              {.binding = 3, .resource = sampled}},
                             {2});
  constexpr std::uint32_t one = 0x3f800000;
  CHECK(seen == Words{0, 0, 0, one, 0, 0, 0, 0, 0, 0, 0, one});
}

TANDEM_DEVICE_TEST("a shader's own arrays and vectors take no index outside of them") {
  // What is read is undefined; the process goes on.
  const Words seen = answers(device, R"(
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { uint answers[2]; };
layout(push_constant) uniform Constants { int far; };
void main() {
  uint own[4] = uint[](1, 2, 3, 4);
  uvec3 three = uvec3(1, 2, 3);
  mat4 matrix = mat4(1);
  own[far] = own[far] + three[far];
  matrix[far] = vec4(own[far]);
  answers[0] = own[2] + own[far] + uint(matrix[far].x);
  answers[1] = 42;
})",
                             2, {}, {0x00ffffff});
  CHECK(seen[1] == 42);
}
