#include "rhi_cpu/shader_table.hpp"

#include <algorithm>
#include <cstring>

namespace tandem::cpu {

ShaderTable::ShaderTable(DeviceStateHandle device, const rhi::ShaderTableDesc& desc)
    : rhi::ShaderTable(desc),
      device_(std::move(device)),
      pipeline_(own<RayTracingPipeline>(desc.pipeline, *device_, desc.label)) {
  const rhi::RayTracingPipelineDesc& shaders = pipeline_->desc();
  ray_generation_ = general_records(desc.ray_generation, shaders.ray_generation);
  miss_ = general_records(desc.miss, shaders.miss);
  hit_ = hit_records(desc.hit);
  callable_ = general_records(desc.callable, shaders.callable);
  for (const HitRecord& record : hit_) {
    has_closest_hit_ = has_closest_hit_ || record.closest_hit != rhi::no_shader;
    has_any_hit_ = has_any_hit_ || record.any_hit != rhi::no_shader;
    has_intersection_ = has_intersection_ || record.intersection != rhi::no_shader;
  }
}

const std::byte* ShaderTable::keep(const rhi::ShaderRecord& record, std::initializer_list<std::uint32_t> shaders) {
  std::size_t size = record.data.size();
  for (const std::uint32_t shader : shaders)
    if (shader != rhi::no_shader)
      size = std::max<std::size_t>(size, pipeline_->kernels()[shader].info->shader_record_size);
  if (size == 0) return nullptr;
  std::vector<Block>& blocks = data_.emplace_back((size + sizeof(Block) - 1) / sizeof(Block), Block{});
  std::byte* bytes = blocks.front().bytes;
  std::copy(record.data.begin(), record.data.end(), bytes);
  return bytes;
}

std::vector<GeneralRecord> ShaderTable::general_records(const rhi::ShaderRecords& records,
                                                        std::span<const rhi::ShaderModuleHandle> shaders) {
  std::vector<GeneralRecord> result;
  for (const rhi::ShaderRecord& record : records.records) {
    GeneralRecord& general = result.emplace_back();
    if (record.shader != rhi::no_shader) general.shader = pipeline_->position_of(shaders[record.shader]);
    general.data = keep(record, {general.shader});
  }
  return result;
}

std::vector<HitRecord> ShaderTable::hit_records(const rhi::ShaderRecords& records) {
  std::vector<HitRecord> result;
  for (const rhi::ShaderRecord& record : records.records) {
    HitRecord& hit = result.emplace_back();
    if (record.shader != rhi::no_shader) {
      const rhi::HitGroup& group = pipeline_->desc().hit_groups[record.shader];
      hit.closest_hit = pipeline_->position_of(group.closest_hit);
      hit.any_hit = pipeline_->position_of(group.any_hit);
      hit.intersection = pipeline_->position_of(group.intersection);
    }
    hit.data = keep(record, {hit.closest_hit, hit.any_hit, hit.intersection});
  }
  return result;
}

}  // namespace tandem::cpu
