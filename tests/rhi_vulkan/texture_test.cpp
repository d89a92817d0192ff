#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/rhi/dispatch.hpp"
#include "tests/rhi_vulkan/silent_device.hpp"

using namespace tandem;
using rhi::TextureDimension;
using rhi::TextureFormat;
using Values = std::vector<std::uint32_t>;

namespace {

/// The bytes of a texture.
std::vector<std::byte> contents(rhi::Device& device, const rhi::TextureHandle& texture) {
  const rhi::BufferHandle buffer = device.create_buffer({.size = texture->size_in_bytes(), .label = "texels"});
  const rhi::CommandListHandle list = device.create_command_list("read texels");
  list->copy_from_texture(texture, {buffer});
  device.submit(list);
  return test::contents<std::byte>(device, buffer, texture->size_in_bytes());
}

}  // namespace

TEST_CASE("vulkan: texels of every format and dimension survive the way there and back") {
  const test::SilentDevice device;
  for (std::uint32_t format = 0; format <= static_cast<std::uint32_t>(TextureFormat::rgba32_float); ++format) {
    for (const TextureDimension dimension :
         {TextureDimension::d1, TextureDimension::d2, TextureDimension::d3, TextureDimension::d2_array}) {
      const std::uint32_t number = static_cast<std::uint32_t>(dimension);
      CAPTURE(format);
      CAPTURE(number);
      rhi::TextureDesc desc;
      desc.format = static_cast<TextureFormat>(format);
      desc.dimension = dimension;
      desc.size = {5, number > 0 ? 3u : 1u, number > 1 ? 4u : 1u};
      desc.label = "texture";
      const rhi::TextureHandle texture = device->create_texture(desc);
      // Small halves and floats, and no integer of -1 that normalisation could change.
      std::vector<std::byte> bytes(16 + texture->size_in_bytes());
      for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * 7 % 60);
      const rhi::BufferHandle source = test::buffer_of(*device, bytes, "source");
      const rhi::CommandListHandle list = device->create_command_list("write texels");
      list->copy_to_texture({.buffer = source, .offset = 16}, texture);
      device->submit(list);
      CHECK(contents(*device, texture) == std::vector<std::byte>(bytes.begin() + 16, bytes.end()));
    }
  }
}

TEST_CASE("vulkan: shaders read and write storage images, atomically where the format allows it") {
  const test::SilentDevice device;
  rhi::TextureDesc desc;
  desc.format = TextureFormat::rgba32_float;
  desc.size = {4, 2, 1};
  desc.label = "colours";
  const rhi::TextureHandle colours = device->create_texture(desc);
  desc.format = TextureFormat::r32_uint;
  desc.dimension = TextureDimension::d2_array;
  desc.size = {1, 1, 2};
  desc.label = "counters";
  const rhi::TextureHandle counters = device->create_texture(desc);
  desc.label = "more counters";
  const rhi::TextureHandle more_counters = device->create_texture(desc);
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(*device, R"(#version 460
#extension GL_EXT_nonuniform_qualifier : require
layout(local_size_x = 4, local_size_y = 2) in;
layout(set = 0, binding = 0, rgba32f) uniform image2D colours;
layout(set = 0, binding = 1, r32ui) uniform uimage2DArray counters[2];
void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  vec4 colour = imageLoad(colours, texel);
  imageStore(colours, texel, colour * 2.0 + vec4(imageSize(colours), 0.5, -1.0));
  imageAtomicAdd(counters[nonuniformEXT(texel.x / 2)], ivec3(0, 0, texel.y), 1u + texel.x);
})",
                                                                     "images");
  const rhi::BindGroupHandle group =
      device->create_bind_group({.pipeline = pipeline,
                                 .entries = {{.binding = 0, .resource = colours},
                                             {.binding = 1, .resource = counters, .array_element = 0},
                                             {.binding = 1, .resource = more_counters, .array_element = 1}},
                                 .label = "images"});
  std::vector<float> before(32);
  for (std::size_t i = 0; i < before.size(); ++i) before[i] = static_cast<float>(i);
  const rhi::BufferHandle zeros = test::buffer_of(*device, Values(2), "zeros");
  const rhi::BufferHandle colour_buffer = test::buffer_of(*device, before, "colours");
  const rhi::BufferHandle counts = test::buffer_of(*device, Values(8), "counts");
  const rhi::CommandListHandle list = device->create_command_list("images");
  list->copy_to_texture({zeros}, counters);
  list->copy_to_texture({zeros}, more_counters);
  list->copy_to_texture({colour_buffer}, colours);
  list->dispatch({.pipeline = pipeline, .bind_groups = {group}});
  list->copy_from_texture(colours, {colour_buffer});
  list->copy_from_texture(counters, {.buffer = counts, .offset = 0, .size = 8});
  list->copy_from_texture(more_counters, {.buffer = counts, .offset = 16, .size = 8});
  device->submit(list);
  const std::vector<float> after = test::contents<float>(*device, colour_buffer, 32);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const std::array<float, 4> added = {4, 2, 0.5f, -1};
    CHECK(after[i] == before[i] * 2 + added[i % 4]);
  }
  CHECK(test::contents<std::uint32_t>(*device, counts, 6) == Values{3, 3, 0, 0, 7, 7});
}

TEST_CASE("vulkan: many textures and buffers come and go") {
  const test::SilentDevice device;
  rhi::TextureDesc desc;
  desc.format = TextureFormat::rgba32_float;
  desc.size = {64, 64, 1};
  for (int round = 0; round < 40; ++round) {
    const rhi::TextureHandle texture = device->create_texture(desc);
    const rhi::BufferHandle buffer = device->create_buffer({.size = 64 * 64 * 16, .label = "texels"});
    const rhi::CommandListHandle list = device->create_command_list("copy");
    list->fill({buffer}, static_cast<std::uint32_t>(round));
    list->copy_to_texture({buffer}, texture);
    list->fill({buffer}, 99);
    list->copy_from_texture(texture, {buffer});
    device->submit(list);
    REQUIRE(test::contents<std::uint32_t>(*device, buffer, 64 * 64 * 4) ==
            Values(64 * 64 * 4, static_cast<std::uint32_t>(round)));
  }
}
