#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "rhi/device.hpp"
#include "rhi_cpu/kernel/shader_call.hpp"

/// Ray tracing shaders that are C++ functions of a test, and scenes whose hits a test lists: neither the translator nor
/// a tracer has a part in what they show of the device.
namespace tandem::test {

struct ScriptedShader {
  rhi::ShaderStage stage = rhi::ShaderStage::ray_generation;
  std::function<void(kernel::ShaderCall&)> run;
  std::uint32_t payload_size = 0;
  std::uint32_t shader_record_size = 0;
};

/// Which shaders (positions in ScriptedPipeline's list, -1: none) make up a hit group.
struct ScriptedHitGroup {
  int closest_hit = -1;
  int any_hit = -1;
  int intersection = -1;
};

/// A device, and a pipeline of scripted shaders on it. One lives at a time.
class ScriptedPipeline {
 public:
  /// Shader 0 is the ray generation shader; miss and callable shaders are numbered in the order of the list.
  ScriptedPipeline(std::vector<ScriptedShader> shaders, const std::vector<ScriptedHitGroup>& hit_groups,
                   std::uint32_t max_recursion_depth = 1, std::uint32_t thread_count = 2);

  rhi::Device& device() const { return *device_; }
  const rhi::RayTracingPipelineHandle& pipeline() const { return pipeline_; }
  /// A table with a record for each ray generation, miss and callable shader, and those hit groups.
  rhi::ShaderTableDesc table_desc(const std::vector<std::uint32_t>& hit_records) const;
  void submit(const rhi::TraceRaysDesc& desc) const;
  void trace_table(const rhi::ShaderTableHandle& table, std::array<std::uint32_t, 3> size = {1, 1, 1}) const;
  /// With table_desc(hit_records).
  void trace(const std::vector<std::uint32_t>& hit_records, std::array<std::uint32_t, 3> size = {1, 1, 1}) const;

 private:
  rhi::DeviceHandle device_;
  rhi::RayTracingPipelineHandle pipeline_;
};

/// A scene in which every ray meets the same triangles and boxes, in the order of the list.
struct ScriptedScene : kernel::TopLevel {
  explicit ScriptedScene(std::vector<kernel::Hit> scripted_hits, std::vector<std::uint32_t> sbt_offsets = {0});

  std::vector<kernel::Hit> hits;
  std::vector<kernel::Instance> instance_storage;
  mutable std::atomic<int> closest_calls = 0;
  mutable std::atomic<int> occluded_calls = 0;
  mutable std::atomic<int> visit_calls = 0;
};

kernel::Hit triangle_at(float t, bool opaque);
kernel::Hit box_at(float t, bool opaque);

/// A ray from 0 to 100 that meets everything.
kernel::Ray ray_with(std::uint32_t flags);

/// A call of traceRayEXT with SBT offset 0, stride 1 and miss index 0.
template <typename Payload>
void trace(kernel::ShaderCall& caller, const kernel::TopLevel& scene, const kernel::Ray& ray, Payload& payload) {
  caller.functions->trace_ray(caller, &scene, ray, 0, 1, 0, &payload, sizeof(Payload));
}

}  // namespace tandem::test
