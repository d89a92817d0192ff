#include <doctest/doctest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rhi_vulkan/make_device.hpp"
#include "tests/rhi_vulkan/ray_tracing_test.hpp"

using namespace tandem;
using rhi::ShaderStage;

namespace {

/// The first device with some of its features left off, and what the validation layer says of it.
struct ReducedDevice {
  template <typename Reduce>
  explicit ReducedDevice(Reduce&& reduce) {
    auto instance = std::make_unique<vulkan::Instance>(
        true, [messages = messages](const rhi::Message& message) { messages->push_back(message.text); });
    vulkan::PhysicalDevice physical = std::move(vulkan::find_physical_devices(*instance).qualifying.at(0));
    reduce(physical);
    device = vulkan::make_device(std::move(instance), std::move(physical));
  }

  std::shared_ptr<std::vector<std::string>> messages = std::make_shared<std::vector<std::string>>();
  rhi::DeviceHandle device;
};

const std::string query_source = R"(#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1) buffer Results { uint results[]; };
void main() {
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, 0, 255, vec3(0), 0, vec3(1), 1);
  rayQueryProceedEXT(query);
  results[0] = rayQueryGetIntersectionTypeEXT(query, true);
})";

}  // namespace

TEST_CASE("vulkan: a device without ray queries, as data-centre GPUs are, traces rays through pipelines") {
  const ReducedDevice reduced([](vulkan::PhysicalDevice& physical) {
    physical.features.ray_query = vk::PhysicalDeviceRayQueryFeaturesKHR();
    physical.info.capabilities.ray_query = false;
  });
  rhi::Device& device = *reduced.device;
  CHECK_ERROR(unsupported, "RayQueryKHR", test::compute_pipeline(device, query_source, "query"));

  const rhi::AccelerationStructureHandle bottom_level =
      test::build_bottom_level(device, {test::triangles_of(device, test::triangle_at(0, 0, 0))});
  const rhi::AccelerationStructureHandle top_level = test::build_top_level(device, {rhi::make_instance(*bottom_level)});
  rhi::RayTracingPipelineDesc pipeline;
  pipeline.ray_generation = {test::ray_shader(device, ShaderStage::ray_generation, test::grid_of_rays, "grid")};
  pipeline.miss = {test::ray_shader(device, ShaderStage::miss, test::answer("value"), "miss")};
  pipeline.hit_groups.resize(1);
  pipeline.hit_groups[0].closest_hit =
      test::ray_shader(device, ShaderStage::closest_hit, test::answer("value"), "closest hit");
  pipeline.label = "pipeline";
  rhi::ShaderTableDesc table;
  table.pipeline = device.create_ray_tracing_pipeline(pipeline);
  table.ray_generation.records.resize(1);
  table.miss.records = {{.shader = 0, .data = test::bytes_of(5)}};
  table.hit.records = {{.shader = 0, .data = test::bytes_of(6)}};
  table.label = "table";
  const rhi::BufferHandle results = test::buffer_of(device, std::vector<std::uint32_t>(2), "results");
  rhi::TraceRaysDesc trace;
  trace.table = device.create_shader_table(table);
  trace.bind_groups = {device.create_bind_group(
      {.pipeline = table.pipeline,
       .entries = {{.binding = 0, .resource = top_level}, {.binding = 1, .resource = rhi::BufferRange{results}}},
       .label = "scene and results"})};
  trace.size = {2, 1, 1};
  const rhi::CommandListHandle list = device.create_command_list("trace");
  list->trace_rays(trace);
  device.submit(list);
  CHECK(test::contents<std::uint32_t>(device, results, 2) == std::vector<std::uint32_t>{6, 5});
  for (const std::string& message : *reduced.messages) FAIL_CHECK(message);
}

TEST_CASE("vulkan: a device without ray tracing pipelines refuses them by name and runs ray queries") {
  const ReducedDevice reduced([](vulkan::PhysicalDevice& physical) {
    physical.features.ray_tracing_pipeline = vk::PhysicalDeviceRayTracingPipelineFeaturesKHR();
    physical.features.ray_tracing_maintenance1 = vk::PhysicalDeviceRayTracingMaintenance1FeaturesKHR();
    physical.features.robustness2 = vk::PhysicalDeviceRobustness2FeaturesEXT();
    physical.shader_stages = vk::ShaderStageFlagBits::eCompute;
    physical.info.capabilities.ray_tracing_pipeline = false;
    physical.info.capabilities.null_acceleration_structure = false;
  });
  rhi::Device& device = *reduced.device;
  const std::vector<std::string> reasons =
      device.refusals(test::ray_shader(device, ShaderStage::ray_generation, test::grid_of_rays, "grid"));
  REQUIRE(reasons.size() == 2);
  CHECK(reasons[0].find("has no ray tracing pipelines") != std::string::npos);
  CHECK(reasons[1].find("RayTracingKHR") != std::string::npos);
  CHECK_ERROR(unsupported, "has no ray tracing pipelines", device.create_ray_tracing_pipeline({}));
  const rhi::AccelerationStructureHandle bottom_level =
      test::build_bottom_level(device, {test::triangles_of(device, test::triangle_at(0, 0, 0))});
  const rhi::AccelerationStructureHandle top_level = test::build_top_level(device, {rhi::make_instance(*bottom_level)});
  CHECK(test::trace(device, top_level, {{.origin = {0.25f, 0.25f, 5}}})[0].type == 1);
  CHECK_ERROR(unsupported, "names no acceleration structure", test::trace(device, nullptr, {test::ProbeRay()}));
  for (const std::string& message : *reduced.messages) FAIL_CHECK(message);
}
