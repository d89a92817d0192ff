#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "rhi/shader_table.hpp"
#include "rhi_vulkan/buffer.hpp"
#include "rhi_vulkan/ray_tracing_pipeline.hpp"

namespace tandem::vulkan {

/// Where the records of one kind lie in the memory of a table. Vulkan wants the address at which a trace's records
/// begin to be a multiple of shaderGroupBaseAlignment, which a record in the middle need not be. So the records lie
/// there as often as it takes for each to be aligned in one copy: copy i has records i, i + n, i + 2 n, ... aligned,
/// where n is the number of copies.
struct RecordPlacement {
  std::uint64_t stride = 0;
  std::uint64_t count = 0;
  std::vector<std::uint64_t> copies;  ///< the offset of record 0 of each

  /// The offset of a record, a multiple of the alignment.
  std::uint64_t aligned_offset(std::uint32_t record) const;
};

/// @param begin the first free byte, moved behind the last copy
/// @param alignment a power of two
RecordPlacement place_records(std::uint64_t stride, std::uint64_t count, std::uint64_t alignment, std::uint64_t& begin);

class ShaderTable final : public rhi::ShaderTable {
 public:
  ShaderTable(ContextHandle context, const rhi::ShaderTableDesc& desc);

  const ContextHandle& context() const noexcept { return context_; }
  const RayTracingPipeline& pipeline() const noexcept { return *pipeline_; }
  /// One ray generation record.
  vk::StridedDeviceAddressRegionKHR ray_generation(std::uint32_t record) const;
  /// The records from `first` on; where there are none, one that runs nothing stands for every index.
  vk::StridedDeviceAddressRegionKHR records(GroupKind kind, std::uint32_t first) const;

 private:
  void write(GroupKind kind, const rhi::ShaderRecords& records, std::span<std::byte> memory) const;
  void upload(std::span<const std::byte> memory);

  ContextHandle context_;
  std::shared_ptr<const RayTracingPipeline> pipeline_;
  std::array<RecordPlacement, 4> placements_;  // by GroupKind
  std::shared_ptr<BackedBuffer> buffer_;       // shared with the submission that fills it
  std::uint64_t address_ = 0;                  // of offset 0, aligned
};

}  // namespace tandem::vulkan
