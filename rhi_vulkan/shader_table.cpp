#include "rhi_vulkan/shader_table.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include "rhi_vulkan/command_buffer.hpp"

namespace tandem::vulkan {
namespace {

std::uint64_t round_up(std::uint64_t value, std::uint64_t alignment) {
  return (value + alignment - 1) & ~(alignment - 1);
}

/// The stride asked for, or the smallest that holds every record.
std::uint64_t stride_of(const rhi::ShaderRecords& records, const rhi::Limits& limits) {
  if (records.stride != 0) return records.stride;
  std::size_t largest = 0;
  for (const rhi::ShaderRecord& record : records.records) largest = std::max(largest, record.data.size());
  return round_up(limits.shader_handle_size + largest, limits.shader_record_alignment);
}

}  // namespace

std::uint64_t RecordPlacement::aligned_offset(std::uint32_t record) const {
  return copies[record % copies.size()] + record * stride;
}

RecordPlacement place_records(std::uint64_t stride, std::uint64_t count, std::uint64_t alignment,
                              std::uint64_t& begin) {
  RecordPlacement placement = {.stride = stride, .count = count, .copies = {}};
  const std::uint64_t copies = std::min(alignment / std::gcd(stride, alignment), count);
  for (std::uint64_t i = 0; i < copies; ++i) {
    placement.copies.push_back(round_up(begin + i * stride, alignment) - i * stride);
    begin = placement.copies.back() + count * stride;
  }
  return placement;
}

ShaderTable::ShaderTable(ContextHandle context, const rhi::ShaderTableDesc& desc)
    : rhi::ShaderTable(desc), context_(std::move(context)) {
  own<RayTracingPipeline>(desc.pipeline, context_, desc.label, "pipeline");
  pipeline_ = std::static_pointer_cast<const RayTracingPipeline>(desc.pipeline);
  const rhi::Limits& limits = context_->physical.info.limits;
  const std::array<const rhi::ShaderRecords*, 4> kinds = {&desc.ray_generation, &desc.miss, &desc.hit, &desc.callable};
  std::uint64_t size = limits.shader_handle_size;  // behind the record that runs nothing, which is all zeros
  for (std::size_t i = 0; i < kinds.size(); ++i)
    placements_[i] = place_records(stride_of(*kinds[i], limits), kinds[i]->records.size(),
                                   context_->physical.shader_table_alignment, size);
  std::vector<std::byte> memory(size);
  for (std::size_t i = 0; i < kinds.size(); ++i) write(static_cast<GroupKind>(i), *kinds[i], memory);
  upload(memory);
}

void ShaderTable::write(GroupKind kind, const rhi::ShaderRecords& records, std::span<std::byte> memory) const {
  const RecordPlacement& placement = placements_[static_cast<std::size_t>(kind)];
  const std::size_t handle_size = context_->physical.info.limits.shader_handle_size;
  for (const std::uint64_t copy : placement.copies) {
    for (std::size_t i = 0; i < records.records.size(); ++i) {
      const rhi::ShaderRecord& record = records.records[i];
      std::byte* const place = memory.data() + copy + i * placement.stride;
      if (record.shader != rhi::no_shader)
        std::memcpy(place, pipeline_->group_handle(kind, record.shader).data(), handle_size);
      if (!record.data.empty()) std::memcpy(place + handle_size, record.data.data(), record.data.size());
    }
  }
}

void ShaderTable::upload(std::span<const std::byte> memory) {
  using Usage = vk::BufferUsageFlagBits;
  const std::uint64_t alignment = context_->physical.shader_table_alignment;
  translating_errors(label(), "create the shader table", [&] {
    buffer_ = std::make_shared<BackedBuffer>(
        make_backed_buffer(*context_, memory.size() + alignment,
                           Usage::eShaderBindingTableKHR | Usage::eShaderDeviceAddress | Usage::eTransferDst,
                           MemoryKind::device, label()));
    const std::uint64_t begin = device_address(*context_, *buffer_);
    address_ = round_up(begin, alignment);
    const auto staging = std::make_shared<BackedBuffer>(
        make_backed_buffer(*context_, memory.size(), Usage::eTransferSrc, MemoryKind::upload, label()));
    std::memcpy(staging->memory.mapped(), memory.data(), memory.size());
    // Nobody waits: what uses the table is submitted later, and begins with a barrier.
    submit_commands(*context_, label(),
                    std::make_shared<std::pair<decltype(buffer_), decltype(buffer_)>>(buffer_, staging),
                    [&](const vk::raii::CommandBuffer& commands) {
                      commands.copyBuffer(*staging->handle, *buffer_->handle,
                                          vk::BufferCopy{.dstOffset = address_ - begin, .size = memory.size()});
                    });
  });
}

vk::StridedDeviceAddressRegionKHR ShaderTable::ray_generation(std::uint32_t record) const {
  const RecordPlacement& placement = placements_[static_cast<std::size_t>(GroupKind::ray_generation)];
  return {.deviceAddress = address_ + placement.aligned_offset(record),
          .stride = placement.stride,
          .size = placement.stride};
}

vk::StridedDeviceAddressRegionKHR ShaderTable::records(GroupKind kind, std::uint32_t first) const {
  const RecordPlacement& placement = placements_[static_cast<std::size_t>(kind)];
  if (first >= placement.count)
    return {.deviceAddress = address_, .stride = 0, .size = context_->physical.info.limits.shader_handle_size};
  return {.deviceAddress = address_ + placement.aligned_offset(first),
          .stride = placement.stride,
          .size = (placement.count - first) * placement.stride};
}

}  // namespace tandem::vulkan
