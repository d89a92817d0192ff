#include <doctest/doctest.h>

#include <array>

#include "tests/rhi_vulkan/ray_tracing_test.hpp"
#include "tests/rhi_vulkan/silent_device.hpp"

using namespace tandem;
using rhi::ShaderStage;
using test::bytes_of;
using test::ray_shader;
using Values = std::vector<std::uint32_t>;

namespace {

/// Triangles of one instance each, at x = 0, 2, 4, ..., with SBT offsets 0, 1, 2, ...
struct Scene {
  Scene(rhi::Device& device, std::uint32_t count, rhi::GeometryFlags flags = rhi::GeometryFlags::opaque)
      : Scene(device, count, test::triangles_of(device, test::triangle_at(0, 0, 0), flags)) {}

  Scene(rhi::Device& device, std::uint32_t count, const rhi::Geometry& geometry)
      : bottom_level(test::build_bottom_level(device, {geometry})) {
    std::vector<rhi::InstanceDesc> instances;
    for (std::uint32_t i = 0; i < count; ++i) {
      instances.push_back(rhi::make_instance(*bottom_level));
      instances.back().object_to_world[0][3] = 2.0f * static_cast<float>(i);
      instances.back().sbt_offset = i & 0xffffff;
    }
    top_level = test::build_top_level(device, instances);
  }

  rhi::AccelerationStructureHandle bottom_level;
  rhi::AccelerationStructureHandle top_level;
};

rhi::RayTracingPipelineDesc simple_pipeline(rhi::Device& device) {
  rhi::RayTracingPipelineDesc desc;
  desc.ray_generation = {ray_shader(device, ShaderStage::ray_generation, test::grid_of_rays, "grid")};
  desc.miss = {ray_shader(device, ShaderStage::miss, test::answer("value + 1u"), "miss")};
  desc.hit_groups = {
      {.closest_hit = ray_shader(device, ShaderStage::closest_hit, test::answer("value + 2u"), "closest hit"),
       .any_hit = nullptr,
       .intersection = nullptr}};
  desc.label = "pipeline";
  return desc;
}

rhi::ShaderRecords records(const std::vector<rhi::ShaderRecord>& records, std::uint32_t stride = 0) {
  return {.records = records, .stride = stride};
}

/// Traces `count` rays in a row and returns what they brought back.
Values trace(rhi::Device& device, const rhi::ShaderTableHandle& table, const rhi::AccelerationStructureHandle& scene,
             std::uint32_t count, rhi::TraceRaysDesc desc = {}) {
  const rhi::BufferHandle results = test::buffer_of(device, Values(count), "results");
  desc.table = table;
  desc.bind_groups = {device.create_bind_group(
      {.pipeline = table->desc().pipeline,
       .entries = {{.binding = 0, .resource = scene}, {.binding = 1, .resource = rhi::BufferRange{results}}},
       .label = "scene and results"})};
  desc.size = {count, 1, 1};
  const rhi::CommandListHandle list = device.create_command_list("trace");
  list->trace_rays(desc);
  device.submit(list);
  return test::contents<std::uint32_t>(device, results, count);
}

}  // namespace

TEST_CASE("vulkan: rays run the shaders of their records with the records' data") {
  const test::SilentDevice device;
  const Scene scene(*device, 2);
  const rhi::RayTracingPipelineHandle pipeline = device->create_ray_tracing_pipeline(simple_pipeline(*device));
  rhi::ShaderTableDesc desc;
  desc.pipeline = pipeline;
  desc.ray_generation = records({{.shader = 0, .data = {}}});
  desc.miss = records({{.shader = 0, .data = bytes_of(100)}});
  desc.hit = records({{.shader = 0, .data = bytes_of(200)}, {.shader = 0, .data = bytes_of(300)}});
  desc.label = "table";
  CHECK(trace(*device, device->create_shader_table(desc), scene.top_level, 3) == Values{202, 302, 101});
}

TEST_CASE("vulkan: a trace may begin at any record, whatever the alignment of the device") {
  const test::SilentDevice device;
  const Scene scene(*device, 1);
  const rhi::RayTracingPipelineHandle pipeline = device->create_ray_tracing_pipeline(simple_pipeline(*device));
  const std::uint32_t alignment = device->info().limits.shader_record_alignment;
  const std::uint32_t smallest = (device->info().limits.shader_handle_size + 4 + alignment - 1) / alignment * alignment;
  for (const std::uint32_t stride : {0u, smallest, smallest + alignment, smallest + 2 * alignment}) {
    CAPTURE(stride);
    rhi::ShaderTableDesc desc;
    desc.pipeline = pipeline;
    desc.label = "table";
    for (std::uint32_t i = 0; i < 5; ++i) {
      desc.ray_generation.records.push_back({.shader = 0, .data = {}});
      desc.miss.records.push_back({.shader = 0, .data = bytes_of(100 + i)});
      desc.hit.records.push_back({.shader = 0, .data = bytes_of(200 + i)});
    }
    desc.miss.stride = desc.hit.stride = desc.ray_generation.stride = stride;
    const rhi::ShaderTableHandle table = device->create_shader_table(desc);
    for (std::uint32_t first = 0; first < 5; ++first) {
      rhi::TraceRaysDesc trace_desc;
      trace_desc.ray_generation_record = first;
      trace_desc.first_miss_record = first;
      trace_desc.first_hit_record = first;
      CHECK(trace(*device, table, scene.top_level, 2, trace_desc) == Values{202 + first, 101 + first});
    }
  }
}

TEST_CASE("vulkan: a record without a shader, and a table without records, run nothing") {
  const test::SilentDevice device;
  const Scene scene(*device, 1);
  rhi::ShaderTableDesc desc;
  desc.pipeline = device->create_ray_tracing_pipeline(simple_pipeline(*device));
  desc.ray_generation = records({{.shader = 0, .data = {}}});
  desc.label = "table";
  SUBCASE("no records") {}
  SUBCASE("records of no shader") {
    desc.miss = records({{.shader = rhi::no_shader, .data = {}}});
    desc.hit = records({{.shader = rhi::no_shader, .data = {}}});
  }
  CHECK(trace(*device, device->create_shader_table(desc), scene.top_level, 2) == Values{0, 0});
}

TEST_CASE("vulkan: any-hit and intersection shaders decide what is hit") {
  const test::SilentDevice device;
  rhi::RayTracingPipelineDesc desc = simple_pipeline(*device);
  rhi::ShaderTableDesc table;
  table.ray_generation = records({{.shader = 0, .data = {}}});
  table.label = "table";
  SUBCASE("any hit: every other triangle is ignored") {
    desc.hit_groups[0].any_hit = ray_shader(*device, ShaderStage::any_hit, R"(
layout(location = 0) rayPayloadInEXT uint payload;
void main() { if (gl_InstanceID % 2 == 1) ignoreIntersectionEXT; })",
                                            "any hit");
    const Scene scene(*device, 3, rhi::GeometryFlags::none);
    table.pipeline = device->create_ray_tracing_pipeline(desc);
    table.miss = records({{.shader = 0, .data = bytes_of(100)}});
    for (const std::uint32_t value : {200u, 300u, 400u})
      table.hit.records.push_back({.shader = 0, .data = bytes_of(value)});
    CHECK(trace(*device, device->create_shader_table(table), scene.top_level, 3) == Values{202, 101, 402});
  }
  SUBCASE("intersection: the first two boxes report a hit") {
    desc.hit_groups[0].intersection = ray_shader(*device, ShaderStage::intersection, R"(
void main() { if (gl_InstanceID < 2) reportIntersectionEXT(4.5, 7u); })",
                                                 "intersection");
    desc.hit_groups[0].closest_hit =
        ray_shader(*device, ShaderStage::closest_hit, test::answer("value + gl_HitKindEXT + uint(gl_HitTEXT * 2.0)"),
                   "closest hit");
    rhi::AabbGeometry boxes;
    boxes.boxes = {test::buffer_of(*device, std::vector<float>{0, 0, 0, 1, 1, 1}, "box")};
    boxes.box_count = 1;
    const Scene scene(*device, 3, boxes);
    table.pipeline = device->create_ray_tracing_pipeline(desc);
    table.miss = records({{.shader = 0, .data = bytes_of(100)}});
    for (const std::uint32_t value : {200u, 300u, 400u})
      table.hit.records.push_back({.shader = 0, .data = bytes_of(value)});
    CHECK(trace(*device, device->create_shader_table(table), scene.top_level, 3) == Values{216, 316, 101});
  }
}

TEST_CASE("vulkan: specialisation constants reach the shaders that declare them") {
  const test::SilentDevice device;
  const Scene scene(*device, 1);
  rhi::RayTracingPipelineDesc desc = simple_pipeline(*device);
  constexpr std::uint32_t skip_closest_hit = 8;  // gl_RayFlagsSkipClosestHitShaderEXT
  desc.specialization = {{.id = 0, .value = skip_closest_hit}};
  rhi::ShaderTableDesc table;
  table.pipeline = device->create_ray_tracing_pipeline(desc);
  table.ray_generation = records({{.shader = 0, .data = {}}});
  table.miss = records({{.shader = 0, .data = bytes_of(100)}});
  table.hit = records({{.shader = 0, .data = bytes_of(200)}});
  table.label = "table";
  CHECK(trace(*device, device->create_shader_table(table), scene.top_level, 2) == Values{0, 101});
}

TEST_CASE("vulkan: rays are traced by closest-hit shaders down to the recursion depth asked for") {
  const test::SilentDevice device;
  const Scene scene(*device, 1);
  const std::uint32_t depth = device->info().limits.max_ray_recursion_depth;
  REQUIRE(depth >= 1);
  rhi::RayTracingPipelineDesc desc = simple_pipeline(*device);
  desc.max_recursion_depth = depth;
  desc.specialization = {{.id = 1, .value = depth}};
  desc.hit_groups[0].closest_hit = ray_shader(*device, ShaderStage::closest_hit, R"(
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(location = 0) rayPayloadInEXT uint payload;
layout(constant_id = 1) const uint depth = 1;
void main() {
  if (++payload >= depth) return;
  traceRayEXT(scene, 0u, 0xff, 0, 0, 0, vec3(0.25, 0.25, 5.0), 0.0, vec3(0, 0, -1), 100.0, 0);
  payload += 1000u;
})",
                                              "recursion");
  rhi::ShaderTableDesc table;
  table.pipeline = device->create_ray_tracing_pipeline(desc);
  table.ray_generation = records({{.shader = 0, .data = {}}});
  table.hit = records({{.shader = 0, .data = {}}});
  table.label = "table";
  CHECK(trace(*device, device->create_shader_table(table), scene.top_level, 1) == Values{depth + 1000 * (depth - 1)});
}

TEST_CASE("vulkan: callable shaders call each other eight deep") {
  const test::SilentDevice device;
  const Scene scene(*device, 1);
  rhi::RayTracingPipelineDesc desc;
  desc.ray_generation = {ray_shader(*device, ShaderStage::ray_generation, R"(
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1) buffer Results { uint results[]; };
layout(location = 0) callableDataEXT uvec4 data;
layout(location = 0) rayPayloadEXT uint payload;
void main() {
  traceRayEXT(scene, 0u, 0xff, 0, 0, 0, vec3(0), 0.0, vec3(0, 0, -1), 100.0, 0);
  data = uvec4(0u, gl_LaunchIDEXT.x, 0u, 0u);
  executeCallableEXT(0, 0);
  results[gl_LaunchIDEXT.x] = data.z;
})",
                                    "caller")};
  desc.callable = {ray_shader(*device, ShaderStage::callable, R"(
layout(location = 0) callableDataInEXT uvec4 data;
layout(location = 1) callableDataEXT uvec4 inner;
void main() {
  uint local = data.x * 10u + data.y;
  if (data.x + 1u < 8u) {
    inner = uvec4(data.x + 1u, data.yzw);
    executeCallableEXT(0, 1);
    data.z = inner.z;
  }
  data.z += local;
})",
                              "callable")};
  desc.max_recursion_depth = 1;
  desc.label = "callables";
  static_assert(rhi::max_callable_depth == 8);
  rhi::ShaderTableDesc table;
  table.pipeline = device->create_ray_tracing_pipeline(desc);
  table.ray_generation = records({{.shader = 0, .data = {}}});
  table.callable = records({{.shader = 0, .data = {}}});
  table.label = "table";
  // The sum of 10 i + invocation for i from 0 to 7.
  CHECK(trace(*device, device->create_shader_table(table), scene.top_level, 3) == Values{280, 288, 296});
}

TEST_CASE("vulkan: an indirect trace reads its size when it executes, written by a shader just before") {
  const test::SilentDevice device;
  REQUIRE(device->info().capabilities.trace_rays_indirect);
  const Scene scene(*device, 1);
  rhi::ShaderTableDesc desc;
  desc.pipeline = device->create_ray_tracing_pipeline(simple_pipeline(*device));
  desc.ray_generation = records({{.shader = 0, .data = {}}});
  desc.miss = records({{.shader = 0, .data = bytes_of(100)}});
  desc.hit = records({{.shader = 0, .data = bytes_of(200)}});
  desc.label = "table";
  const rhi::ShaderTableHandle table = device->create_shader_table(desc);

  const rhi::BufferHandle size = device->create_buffer(
      {.size = 64, .usage = rhi::BufferUsage::storage | rhi::BufferUsage::indirect, .label = "size"});
  const rhi::ComputePipelineHandle writer = test::compute_pipeline(*device, R"(#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer Size { uint size[]; };
void main() { size[1] = 3u; size[2] = 1u; size[3] = 1u; })",
                                                                   "writer");
  const rhi::BufferHandle results = test::buffer_of(*device, Values(4, 7), "results");
  const rhi::CommandListHandle list = device->create_command_list("indirect");
  list->dispatch(
      {.pipeline = writer,
       .bind_groups = {device->create_bind_group(
           {.pipeline = writer, .entries = {{.binding = 0, .resource = rhi::BufferRange{size}}}, .label = "size"})}});
  rhi::TraceRaysDesc trace;
  trace.table = table;
  trace.indirect_size = {.buffer = size, .offset = 4, .size = 12};
  trace.bind_groups = {device->create_bind_group(
      {.pipeline = desc.pipeline,
       .entries = {{.binding = 0, .resource = scene.top_level}, {.binding = 1, .resource = rhi::BufferRange{results}}},
       .label = "scene and results"})};
  list->trace_rays(trace);
  trace.indirect_size = {};
  trace.size = {4, 0, 1};
  list->trace_rays(trace);
  device->submit(list);
  CHECK(test::contents<std::uint32_t>(*device, results, 4) == Values{202, 101, 101, 7});
}

TEST_CASE("vulkan: one bind group and the same push constants serve a compute and a ray tracing pipeline") {
  const test::SilentDevice device;
  const std::string declarations = R"(
layout(set = 0, binding = 0) buffer Results { uint results[]; };
layout(push_constant) uniform Constants { uint base; };
)";
  const rhi::ComputePipelineHandle compute =
      test::compute_pipeline(*device,
                             "#version 460\nlayout(local_size_x = 1) in;" + declarations +
                                 "void main() { results[gl_GlobalInvocationID.x] = base + gl_GlobalInvocationID.x; }",
                             "compute");
  rhi::RayTracingPipelineDesc desc;
  desc.ray_generation = {ray_shader(*device, ShaderStage::ray_generation,
                                    declarations + "void main() { results[gl_LaunchIDEXT.x] += 10u * base; }",
                                    "ray generation")};
  desc.max_recursion_depth = 0;
  desc.label = "rays";
  rhi::ShaderTableDesc table;
  table.pipeline = device->create_ray_tracing_pipeline(desc);
  table.ray_generation = records({{.shader = 0, .data = {}}});
  table.label = "table";
  const rhi::BufferHandle results = test::buffer_of(*device, Values(4), "results");
  const std::uint32_t base = 5;
  const auto constants = std::as_bytes(std::span(&base, 1));
  for (const rhi::PipelineHandle& maker : {rhi::PipelineHandle(compute), rhi::PipelineHandle(table.pipeline)}) {
    const rhi::BindGroupHandle group = device->create_bind_group(
        {.pipeline = maker, .entries = {{.binding = 0, .resource = rhi::BufferRange{results}}}, .label = "results"});
    const rhi::CommandListHandle list = device->create_command_list("both");
    list->dispatch(
        {.pipeline = compute, .bind_groups = {group}, .push_constants = constants, .workgroup_count = {4, 1, 1}});
    rhi::TraceRaysDesc trace;
    trace.table = device->create_shader_table(table);
    trace.bind_groups = {group};
    trace.push_constants = constants;
    trace.size = {4, 1, 1};
    list->trace_rays(trace);
    device->submit(list);
    CHECK(test::contents<std::uint32_t>(*device, results, 4) == Values{55, 56, 57, 58});
  }
}

TEST_CASE("vulkan: what a trace writes is built from, and what is built is traced, within one list") {
  const test::SilentDevice device;
  const std::string write_vertices = R"(
layout(set = 0, binding = 0) writeonly buffer Vertices { float vertices[]; };
void main() {
  const float corners[9] = float[](0, 0, 0, 1, 0, 0, 0, 1, 0);
  vertices[gl_LaunchIDEXT.x] = corners[gl_LaunchIDEXT.x] + (gl_LaunchIDEXT.x % 3u == 0u ? 2.0 : 0.0);
})";
  rhi::RayTracingPipelineDesc desc;
  desc.ray_generation = {ray_shader(*device, ShaderStage::ray_generation, write_vertices, "vertices")};
  desc.max_recursion_depth = 0;
  desc.label = "writer";
  rhi::ShaderTableDesc writer;
  writer.pipeline = device->create_ray_tracing_pipeline(desc);
  writer.ray_generation = records({{.shader = 0, .data = {}}});
  writer.label = "writer";
  rhi::ShaderTableDesc tracer;
  tracer.pipeline = device->create_ray_tracing_pipeline(simple_pipeline(*device));
  tracer.ray_generation = records({{.shader = 0, .data = {}}});
  tracer.miss = records({{.shader = 0, .data = bytes_of(100)}});
  tracer.hit = records({{.shader = 0, .data = bytes_of(200)}});
  tracer.label = "tracer";

  const rhi::TriangleGeometry triangle = test::triangles_of(*device, std::vector<float>(9));
  const rhi::BottomLevelDesc bottom_level_desc = {.geometries = {triangle}, .label = "bottom level"};
  const rhi::AccelerationStructureHandle bottom_level = device->create_bottom_level(bottom_level_desc);
  rhi::TopLevelDesc top_level_desc;
  top_level_desc.instances.buffer =
      test::buffer_of(*device, std::vector<rhi::InstanceDesc>{rhi::make_instance(*bottom_level)}, "instances");
  top_level_desc.instance_count = 1;
  const rhi::AccelerationStructureHandle top_level = device->create_top_level(top_level_desc);
  const rhi::BufferHandle results = test::buffer_of(*device, Values(3), "results");

  const rhi::CommandListHandle list = device->create_command_list("all");
  rhi::TraceRaysDesc trace;
  trace.table = device->create_shader_table(writer);
  trace.bind_groups = {device->create_bind_group(
      {.pipeline = writer.pipeline, .entries = {{.binding = 0, .resource = triangle.vertices}}, .label = "vertices"})};
  trace.size = {9, 1, 1};
  list->trace_rays(trace);
  list->build_bottom_level(bottom_level, bottom_level_desc);
  list->build_top_level(top_level, top_level_desc);
  trace.table = device->create_shader_table(tracer);
  trace.bind_groups = {device->create_bind_group(
      {.pipeline = tracer.pipeline,
       .entries = {{.binding = 0, .resource = top_level}, {.binding = 1, .resource = rhi::BufferRange{results}}},
       .label = "scene and results"})};
  trace.size = {3, 1, 1};
  list->trace_rays(trace);
  device->submit(list);
  CHECK(test::contents<std::uint32_t>(*device, results, 3) == Values{101, 202, 101});
}
