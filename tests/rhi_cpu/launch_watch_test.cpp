#include <doctest/doctest.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "rhi/error.hpp"
#include "rhi/glsl/compile.hpp"
#include "rhi/transfer.hpp"
#include "rhi_cpu/device.hpp"

namespace tandem::cpu {
namespace {

using Words = std::vector<std::uint32_t>;

rhi::ShaderModuleHandle module_of(rhi::Device& device, rhi::ShaderStage stage, const std::string& glsl) {
  const Words spirv = glsl::compile("#version 460\n" + glsl, stage, "shader");
  return device.create_shader_module({.spirv = spirv, .label = "shader"});
}

/// Runs the shader over one buffer of these words and returns what it left there.
Words run(rhi::Device& device, const std::string& glsl, const Words& words) {
  const rhi::ComputePipelineHandle pipeline = device.create_compute_pipeline(
      {.shader = module_of(device, rhi::ShaderStage::compute, glsl), .specialization = {}, .label = "loops"});
  const rhi::BufferHandle buffer = rhi::create_filled(device, words, rhi::BufferUsage::storage, "words");
  const rhi::CommandListHandle list = device.create_command_list("loops");
  list->dispatch(
      {.pipeline = pipeline,
       .bind_groups = {device.create_bind_group({.pipeline = pipeline,
                                                 .entries = {{.binding = 0, .resource = rhi::BufferRange{buffer}}},
                                                 .label = "group"})}});
  try {
    device.submit(list);
  } catch (const rhi::Error& error) {
    CHECK(error.code() == rhi::ErrorCode::timeout);
    CHECK(std::string(error.what()).find("loops: it ran for more than the 50 ms") == 0);
  }
  return rhi::read<std::uint32_t>(device, buffer, words.size());
}

rhi::DeviceHandle limited_device() {
  rhi::DeviceDesc desc;
  desc.time_limit = std::chrono::milliseconds(50);
  return create_device(desc, {});
}

// The device is as usable as before, and loops that end give what they give without a limit.
TEST_CASE("an endless loop is stopped, whatever its form") {
  const rhi::DeviceHandle device = limited_device();
  const std::string head = "layout(local_size_x = 1) in;\nlayout(binding = 0) buffer B { uint b[4]; };\n";
  // One shader with each kind of loop behind a condition, so that there is one kernel to compile.
  const std::string loops = head + R"(
void main() {
  b[3] = 1;
  if (b[0] == 1) while (b[1] == 0) {}
  if (b[0] == 2) { do { b[2]++; } while (b[1] == 0); }
  if (b[0] == 3) for (uint i = 0; i != 1; i += 2) { if (i == b[2]) continue; b[2] = i; }
  uint x = b[2];
  for (uint i = 0; i < 100; ++i) for (uint j = 0; j < i; ++j) x = x * 3 + j;
  b[2] = x;
  b[3] = 2;
})";
  const Words ended = run(*device, loops, {0, 0, 5, 0});
  CHECK(ended[3] == 2);
  CHECK(ended[2] == run(*create_device({}, {}), loops, {0, 0, 5, 0})[2]);
  for (const std::uint32_t kind : {1u, 2u, 3u}) {
    INFO("loop " << kind);
    CHECK(run(*device, loops, {kind, 0, 0, 0})[3] == 1);
  }
  CHECK(run(*device, loops, {0, 0, 5, 0}) == ended);
}

TEST_CASE("a launch of many short invocations is stopped too") {
  const rhi::DeviceHandle device = limited_device();
  const rhi::ComputePipelineHandle pipeline = device->create_compute_pipeline(
      {.shader = module_of(*device, rhi::ShaderStage::compute, R"(layout(local_size_x = 64) in;
layout(binding = 0) buffer B { uint b[4]; };
void main() { for (uint i = 0; i < 40; ++i) atomicAdd(b[i & 3], i); })"),
       .specialization = {},
       .label = "short"});
  const rhi::BufferHandle buffer = rhi::create_filled(*device, Words(4), rhi::BufferUsage::storage, "words");
  const rhi::CommandListHandle list = device->create_command_list("short");
  list->dispatch(
      {.pipeline = pipeline,
       .bind_groups = {device->create_bind_group({.pipeline = pipeline,
                                                  .entries = {{.binding = 0, .resource = rhi::BufferRange{buffer}}},
                                                  .label = "group"})},
       .workgroup_count = {65535, 65535, 1}});
  CHECK_THROWS_WITH_AS(device->submit(list), doctest::Contains("short: it ran for more than the 50 ms"), rhi::Error);
}

TEST_CASE("endless loops of ray tracing shaders are stopped, also in the middle of a traversal") {
  const rhi::DeviceHandle device = limited_device();
  const auto shader = [&](rhi::ShaderStage stage, const std::string& glsl) {
    return module_of(*device, stage, "#extension GL_EXT_ray_tracing : require\n" + glsl);
  };
  const std::vector<float> triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const rhi::BufferHandle vertices =
      rhi::create_filled(*device, triangle, rhi::BufferUsage::acceleration_structure_input, "vertices");
  rhi::BottomLevelDesc bottom;
  rhi::TriangleGeometry triangles;
  triangles.vertices.buffer = vertices;
  triangles.vertex_count = 3;
  triangles.triangle_count = 1;
  triangles.flags = rhi::GeometryFlags::none;
  bottom.geometries = {triangles};
  bottom.label = "triangle";
  const rhi::AccelerationStructureHandle level = device->create_bottom_level(bottom);
  const rhi::BufferHandle instances = rhi::create_filled(*device, std::vector{rhi::make_instance(*level)},
                                                         rhi::BufferUsage::acceleration_structure_input, "instances");
  rhi::TopLevelDesc top;
  top.instances.buffer = instances;
  top.instance_count = 1;
  top.label = "scene";
  const rhi::AccelerationStructureHandle scene = device->create_top_level(top);
  const rhi::CommandListHandle build = device->create_command_list("build");
  build->build_bottom_level(level, bottom);
  build->build_top_level(scene, top);
  device->submit(build);

  rhi::RayTracingPipelineDesc desc;
  desc.ray_generation = {shader(rhi::ShaderStage::ray_generation, R"(
layout(binding = 0) uniform accelerationStructureEXT scene;
layout(location = 0) rayPayloadEXT uint payload;
void main() {
  payload = 0;
  traceRayEXT(scene, gl_RayFlagsNoOpaqueEXT, 0xff, 0, 0, 0, vec3(0.2, 0.2, 1), 0, vec3(0, 0, -1), 2, 0);
})")};
  desc.hit_groups.resize(1);
  desc.hit_groups[0].any_hit = shader(rhi::ShaderStage::any_hit, R"(
layout(location = 0) rayPayloadInEXT uint payload;
void main() { while (payload != 1) payload += 2; })");
  desc.label = "any hit";
  rhi::ShaderTableDesc table;
  table.pipeline = device->create_ray_tracing_pipeline(desc);
  table.ray_generation.records = {{.shader = 0, .data = {}}};
  table.hit.records = {{.shader = 0, .data = {}}};
  table.label = "table";
  rhi::TraceRaysDesc trace;
  trace.table = device->create_shader_table(table);
  trace.bind_groups = {device->create_bind_group(
      {.pipeline = table.pipeline, .entries = {{.binding = 0, .resource = scene}}, .label = "scene"})};
  const rhi::CommandListHandle list = device->create_command_list("trace");
  list->trace_rays(trace);
  CHECK_THROWS_WITH_AS(device->submit(list), doctest::Contains("any hit: it ran for more than the 50 ms"), rhi::Error);
}

}  // namespace
}  // namespace tandem::cpu
