#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "rhi/shader_table.hpp"
#include "rhi_cpu/device_state.hpp"
#include "rhi_cpu/ray_tracing_pipeline.hpp"

namespace tandem::cpu {

/// A ray generation, miss or callable record. Shaders are named by their position in RayTracingPipeline::shaders(), or
/// are rhi::no_shader.
struct GeneralRecord {
  std::uint32_t shader = rhi::no_shader;
  const std::byte* data = nullptr;  ///< aligned to 16, as large as the shader's shaderRecordEXT block
};

struct HitRecord {
  std::uint32_t closest_hit = rhi::no_shader;
  std::uint32_t any_hit = rhi::no_shader;
  std::uint32_t intersection = rhi::no_shader;
  const std::byte* data = nullptr;  ///< as large as the largest block of the three
};

/// Records with their shaders looked up.
class ShaderTable final : public rhi::ShaderTable {
 public:
  ShaderTable(DeviceStateHandle device, const rhi::ShaderTableDesc& desc);

  const DeviceState& device() const noexcept { return *device_; }
  const RayTracingPipeline& pipeline() const noexcept { return *pipeline_; }
  std::span<const GeneralRecord> ray_generation() const noexcept { return ray_generation_; }
  std::span<const GeneralRecord> miss() const noexcept { return miss_; }
  std::span<const HitRecord> hit() const noexcept { return hit_; }
  std::span<const GeneralRecord> callable() const noexcept { return callable_; }
  /// Whether any hit record has a shader of the kind.
  bool has_closest_hit() const noexcept { return has_closest_hit_; }
  bool has_any_hit() const noexcept { return has_any_hit_; }
  bool has_intersection() const noexcept { return has_intersection_; }

 private:
  /// A copy of the record's data, with zeros behind it up to what the shaders read.
  const std::byte* keep(const rhi::ShaderRecord& record, std::initializer_list<std::uint32_t> shaders);
  std::vector<GeneralRecord> general_records(const rhi::ShaderRecords& records,
                                             std::span<const rhi::ShaderModuleHandle> shaders);
  std::vector<HitRecord> hit_records(const rhi::ShaderRecords& records);

  struct alignas(16) Block {
    std::byte bytes[16];
  };

  DeviceStateHandle device_;
  std::shared_ptr<RayTracingPipeline> pipeline_;
  std::vector<std::vector<Block>> data_;
  std::vector<GeneralRecord> ray_generation_;
  std::vector<GeneralRecord> miss_;
  std::vector<HitRecord> hit_;
  std::vector<GeneralRecord> callable_;
  bool has_closest_hit_ = false;
  bool has_any_hit_ = false;
  bool has_intersection_ = false;
};

}  // namespace tandem::cpu
