#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "rhi/error.hpp"
#include "rhi/texture_view.hpp"
#include "rhi/validation.hpp"
#include "tests/rhi/plain_objects.hpp"

// What bind groups may hold, without a device: images, samplers, texel buffers, and arrays of descriptors.

namespace {

using namespace tandem;
using namespace tandem::test;
using rhi::ErrorCode;
using rhi::ShaderStage;
using rhi::TextureDimension;
using rhi::TextureFormat;

/// The sentence of the Error that check() throws; "" when it throws none.
std::string broken_rule(const rhi::BindGroupDesc& desc, const rhi::DeviceInfo& device = able_device()) {
  try {
    rhi::validation::check(desc, device);
  } catch (const rhi::Error& error) {
    return error.what();
  }
  return "";
}

void check_rule(const std::string& sentence, const std::string& part) {
  INFO("the sentence: " << sentence);
  CHECK(sentence.find(part) != std::string::npos);
}

/// A bind group for a ray generation shader with these declarations, which uses `uses`.
rhi::BindGroupDesc group_for(const std::string& declarations, const std::string& uses,
                             std::uint32_t unsized_array_length = 16) {
  rhi::RayTracingPipelineDesc pipeline;
  pipeline.ray_generation = {
      plain_shader(ShaderStage::ray_generation, "layout(location = 0) rayPayloadEXT vec4 payload;\n" + declarations +
                                                    "\nvoid main() { payload = " + uses + "; }")};
  pipeline.max_recursion_depth = 0;
  pipeline.unsized_array_length = unsized_array_length;
  pipeline.label = "pipeline";
  rhi::BindGroupDesc desc;
  desc.pipeline = plain_pipeline(pipeline);
  desc.label = "group";
  return desc;
}

rhi::TextureHandle texture(TextureDimension dimension, std::array<std::uint32_t, 3> size, std::uint32_t levels = 1,
                           TextureFormat format = TextureFormat::rgba8_unorm) {
  return plain_texture(
      {.dimension = dimension, .format = format, .size = size, .level_count = levels, .label = "texture"});
}

TEST_CASE("bind groups: a view names levels and layers that the texture has, seen as the shader declares them") {
  rhi::BindGroupDesc desc =
      group_for("layout(binding = 0, rgba8) uniform image2D image;", "imageLoad(image, ivec2(0))");
  const auto rule = [&](const rhi::TextureView& view) {
    desc.entries = {{.binding = 0, .resource = view}};
    return broken_rule(desc);
  };
  const rhi::TextureHandle layers = texture(TextureDimension::d2_array, {8, 8, 6}, 3);
  CHECK(rule({.texture = layers,
              .first_level = 2,
              .first_layer = 5,
              .layer_count = 1,
              .dimension = TextureDimension::d2}) == "");
  check_rule(rule({.texture = layers, .first_level = 3, .layer_count = 1, .dimension = TextureDimension::d2}),
             "has 3 levels, fewer than are bound");
  check_rule(rule({.texture = layers, .first_layer = 6, .dimension = TextureDimension::d2}),
             "has 6 layers, fewer than are bound");
  check_rule(rule({.texture = layers}), "has another dimension than the image in the shader");
  check_rule(rule({.texture = layers, .dimension = TextureDimension::d2}), "cannot be seen as the image");
  check_rule(rule({.texture = layers, .level_count = 2, .layer_count = 1, .dimension = TextureDimension::d2}),
             "a storage image is one level");
  check_rule(rule({.texture = texture(TextureDimension::d3, {8, 8, 8}), .dimension = TextureDimension::d2}),
             "cannot be seen as the image");
  rhi::DeviceInfo device = able_device();
  device.formats[static_cast<std::size_t>(TextureFormat::rgba8_unorm)].storage = false;
  desc.entries = {{.binding = 0, .resource = texture(TextureDimension::d2, {8, 8, 1})}};
  check_rule(broken_rule(desc, device), "device 'able' has no storage images of the format rgba8_unorm");
}

TEST_CASE("bind groups: a cube has six square layers for each of its cubes") {
  rhi::BindGroupDesc desc = group_for(
      "layout(binding = 0) uniform textureCubeArray image;\n"
      "layout(binding = 1) uniform sampler s;",
      "textureLod(samplerCubeArray(image, s), vec4(0), 0)");
  const auto rule = [&](const rhi::TextureView& view) {
    desc.entries = {{.binding = 0, .resource = view}, {.binding = 1, .resource = plain_sampler({.label = "s"})}};
    return broken_rule(desc);
  };
  const rhi::TextureHandle layers = texture(TextureDimension::d2_array, {8, 8, 13});
  CHECK(rule({.texture = layers, .layer_count = 12, .dimension = TextureDimension::cube_array}) == "");
  check_rule(rule({.texture = layers, .dimension = TextureDimension::cube_array}), "cannot be seen as the image");
  const rhi::TextureHandle oblong = texture(TextureDimension::d2_array, {8, 4, 6});
  check_rule(rule({.texture = oblong, .dimension = TextureDimension::cube_array}), "cannot be seen as the image");
}

TEST_CASE("bind groups: images with their samplers") {
  rhi::BindGroupDesc desc = group_for("layout(binding = 0) uniform sampler2D image;", "textureLod(image, vec2(0), 0)");
  const auto rule = [&](const rhi::TextureHandle& bound, const rhi::SamplerDesc& sampler,
                        const rhi::DeviceInfo& device = able_device()) {
    rhi::SampledTexture sampled;
    sampled.view.texture = bound;
    sampled.sampler = plain_sampler(sampler);
    desc.entries = {{.binding = 0, .resource = sampled}};
    return broken_rule(desc, device);
  };
  const rhi::TextureHandle picture = texture(TextureDimension::d2, {8, 8, 1}, 4);
  rhi::SamplerDesc linear = {.magnification = rhi::Filter::linear, .label = "linear"};
  CHECK(rule(picture, linear) == "");
  rhi::DeviceInfo device = able_device();
  device.formats[static_cast<std::size_t>(TextureFormat::rgba8_unorm)].filtered = false;
  check_rule(rule(picture, linear, device), "device 'able' filters no images of the format rgba8_unorm");
  CHECK(rule(picture, {.label = "nearest"}, device) == "");
  check_rule(rule(picture, {.compare = rhi::CompareOp::less, .label = "c"}),
             "the sampler 'c' compares, where the shader does not want it");
  const rhi::TextureHandle integers = texture(TextureDimension::d2, {8, 8, 1}, 1, TextureFormat::rgba8_uint);
  check_rule(rule(integers, {.label = "nearest"}), "has the format rgba8_uint, where the shader reads floats");
  check_rule(rule(picture, {.unnormalized_coordinates = true, .label = "texels"}), "needs one level");
  check_rule(rule(nullptr, linear), "names no texture");
  desc.entries = {{.binding = 0, .resource = picture}};
  check_rule(broken_rule(desc), "is not a storage image in the shader, nor an image without a sampler");
  desc.entries = {{.binding = 0, .resource = plain_sampler(linear)}};
  check_rule(broken_rule(desc), "is not a sampler in the shader");
}

TEST_CASE("bind groups: shadow samplers compare, on textures of depths") {
  rhi::BindGroupDesc desc =
      group_for("layout(binding = 0) uniform sampler2DShadow image;", "vec4(textureLod(image, vec3(0), 0))");
  const auto rule = [&](TextureFormat format, const rhi::SamplerDesc& sampler) {
    rhi::SampledTexture sampled;
    sampled.view.texture = texture(TextureDimension::d2, {8, 8, 1}, 1, format);
    sampled.sampler = plain_sampler(sampler);
    desc.entries = {{.binding = 0, .resource = sampled}};
    return broken_rule(desc);
  };
  const rhi::SamplerDesc compares = {.compare = rhi::CompareOp::less, .label = "c"};
  CHECK(rule(TextureFormat::d32_float, compares) == "");
  check_rule(rule(TextureFormat::d32_float, {.label = "p"}),
             "the sampler 'p' does not compare, where the shader wants that");
  check_rule(rule(TextureFormat::r32_float, compares), "needs a texture of a depth format");
}

TEST_CASE("bind groups: texel buffers") {
  rhi::BindGroupDesc desc = group_for("layout(binding = 0) uniform samplerBuffer texels;", "texelFetch(texels, 0)");
  const auto rule = [&](std::uint64_t size, rhi::BufferUsage usage, TextureFormat format,
                        const rhi::DeviceInfo& device = able_device()) {
    desc.entries = {{.binding = 0, .resource = rhi::TexelBuffer{{plain_buffer(size, usage)}, format}}};
    return broken_rule(desc, device);
  };
  using enum rhi::BufferUsage;
  CHECK(rule(64, uniform_texels, TextureFormat::rgba32_float) == "");
  check_rule(rule(64, storage, TextureFormat::rgba32_float), "lacks the usage uniform_texels");
  check_rule(rule(63, uniform_texels, TextureFormat::rgba32_float), "63 bytes, which are no whole texels");
  rhi::DeviceInfo device = able_device();
  device.formats[static_cast<std::size_t>(TextureFormat::r8_unorm)].uniform_texel_buffer = false;
  check_rule(rule(64, uniform_texels, TextureFormat::r8_uint), "has the format r8_uint, where the shader reads floats");
  check_rule(rule(64, uniform_texels, TextureFormat::r8_unorm, device), "no texel buffers of the format r8_unorm");
  desc.entries = {{.binding = 0, .resource = rhi::BufferRange{plain_buffer(64, storage)}}};
  check_rule(broken_rule(desc), "is not a buffer in the shader");
}

TEST_CASE("bind groups: elements of arrays may be left out where the device allows it") {
  rhi::BindGroupDesc desc = group_for(
      "layout(binding = 0) uniform Numbers { vec4 number; } numbers[3];\n"
      "layout(binding = 1) uniform One { vec4 number; } one;",
      "numbers[1].number + one.number");
  const rhi::BufferRange range = {plain_buffer(16, rhi::BufferUsage::uniform)};
  desc.entries = {{.binding = 0, .resource = range, .array_element = 1}, {.binding = 1, .resource = range}};
  CHECK(broken_rule(desc) == "");
  rhi::DeviceInfo device = able_device();
  device.capabilities.partially_bound = false;
  check_rule(broken_rule(desc, device), "binding 0 ('Numbers') of pipeline 'pipeline' needs 3 entries, but 1 is given");
  desc.entries.pop_back();
  check_rule(broken_rule(desc), "binding 1 ('One') of pipeline 'pipeline' needs 1 entry, but 0 are given");
}

TEST_CASE("bind groups: an array without a length has as many elements as the pipeline says") {
  rhi::BindGroupDesc desc = group_for("layout(binding = 0) uniform Numbers { vec4 number; } numbers[];",
                                      "numbers[gl_LaunchIDEXT.x].number", 5);
  const rhi::BufferRange range = {plain_buffer(16, rhi::BufferUsage::uniform)};
  desc.entries = {{.binding = 0, .resource = range, .array_element = 4}};
  CHECK(broken_rule(desc) == "");
  desc.entries = {{.binding = 0, .resource = range, .array_element = 5}};
  check_rule(broken_rule(desc), "has 5 elements, so there is no element 5");
}

TEST_CASE("dispatches: a group of another length of the arrays without one does not fit") {
  const std::string declarations = "layout(binding = 0) uniform Numbers { vec4 number; } numbers[];";
  const std::string uses = "numbers[gl_LaunchIDEXT.x].number";
  rhi::BindGroupDesc five = group_for(declarations, uses, 5);
  const rhi::BindGroupDesc six = group_for(declarations, uses, 6);
  five.entries = {{.binding = 0, .resource = rhi::BufferRange{plain_buffer(16, rhi::BufferUsage::uniform)}}};
  rhi::ShaderTableDesc table;
  table.pipeline = std::static_pointer_cast<rhi::RayTracingPipeline>(six.pipeline);
  table.ray_generation.records.resize(1);
  rhi::TraceRaysDesc trace;
  trace.table = plain_table(table);
  trace.bind_groups = {plain_bind_group(five)};
  CHECK_THROWS_WITH_AS(rhi::validation::check(trace, able_device()),
                       doctest::Contains("was made for other bindings of set 0"), rhi::Error);
}

TEST_CASE("pipelines: an array without a length needs a device that has them") {
  rhi::DeviceInfo device = able_device();
  device.capabilities.unsized_arrays = false;
  const rhi::ShaderModuleHandle shader = plain_shader(ShaderStage::ray_generation, R"(
    layout(location = 0) rayPayloadEXT vec4 payload;
    layout(binding = 3) uniform Numbers { vec4 number; } numbers[];
    void main() { payload = numbers[gl_LaunchIDEXT.x].number; })");
  REQUIRE(shader->reflection().bindings.size() == 1);
  CHECK(shader->reflection().bindings[0].count == 0);
  const std::vector<std::string> reasons = rhi::validation::refusals(shader, device);
  REQUIRE(reasons.size() == 1);
  check_rule(reasons[0], "'Numbers', an array of descriptors without a length, which device 'able' does not support");
  CHECK(rhi::validation::refusals(shader, able_device()).empty());
}

TEST_CASE("samplers with unnormalised coordinates keep Vulkan's rules") {
  rhi::SamplerDesc desc = {.address = {rhi::AddressMode::clamp_to_edge, rhi::AddressMode::clamp_to_edge},
                           .max_lod = 0,
                           .unnormalized_coordinates = true,
                           .label = "texels"};
  rhi::validation::check(desc);
  desc.max_lod = 1;
  CHECK_THROWS_WITH_AS(rhi::validation::check(desc), doctest::Contains("texels: a sampler with unnormalised"),
                       rhi::Error);
  desc.unnormalized_coordinates = false;
  desc.min_lod = 2;
  CHECK_THROWS_WITH_AS(rhi::validation::check(desc), doctest::Contains("smallest level of detail"), rhi::Error);
}

TEST_CASE("levels of a texture are halved, layers are not") {
  const rhi::TextureDesc desc = {.dimension = TextureDimension::d2_array,
                                 .format = TextureFormat::r8_unorm,
                                 .size = {5, 2, 3},
                                 .level_count = 3,
                                 .label = "levels"};
  CHECK(rhi::level_size(desc, 1) == std::array<std::uint32_t, 3>{2, 1, 3});
  CHECK(rhi::level_size(desc, 2) == std::array<std::uint32_t, 3>{1, 1, 3});
  CHECK(rhi::level_offset(desc, 1) == 32);  // 30 bytes, then to a multiple of 4
  CHECK(rhi::level_offset(desc, 2) == 40);
  CHECK(plain_texture(desc)->size_in_bytes() == 43);
  CHECK(rhi::full_level_count(desc) == 3);
}

}  // namespace
