#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "rhi/acceleration_structure.hpp"
#include "rhi_vulkan/buffer.hpp"
#include "rhi_vulkan/build_input.hpp"

namespace tandem::vulkan {

class AccelerationStructure final : public rhi::AccelerationStructure {
 public:
  AccelerationStructure(ContextHandle context, const rhi::BottomLevelDesc& desc);
  AccelerationStructure(ContextHandle context, const rhi::TopLevelDesc& desc);
  /// Memory of `size` bytes for a compacted copy of `source`, still to be made.
  AccelerationStructure(const AccelerationStructure& source, std::uint64_t size, std::string label);

  std::uint64_t device_address() const override { return address_; }
  rhi::AccelerationStructureSizes sizes() const override { return sizes_; }
  const ContextHandle& context() const noexcept { return context_; }
  vk::AccelerationStructureKHR handle() const { return *structure_; }
  vk::AccelerationStructureTypeKHR type() const noexcept { return type_; }
  rhi::BuildFlags flags() const noexcept;
  /// A compacted copy has no room for a build.
  bool is_compacted() const noexcept { return is_compacted_; }

  /// What it was created from, without the buffers that only a build reads; empty for the other level.
  const rhi::BottomLevelDesc& bottom_level_desc() const noexcept { return bottom_level_desc_; }
  const rhi::TopLevelDesc& top_level_desc() const noexcept { return top_level_desc_; }

  /// A list was submitted that builds it, a top level from that many instances (a bottom level: 0).
  void mark_built(std::uint32_t instance_count) noexcept { built_instance_count_ = instance_count; }
  /// As of the last build submitted; nothing before the first.
  std::optional<std::uint32_t> built_instance_count() const noexcept;

 private:
  void create(const BuildInput& input);
  void allocate(std::uint64_t size);

  static constexpr std::int64_t never_built = -1;

  ContextHandle context_;
  vk::AccelerationStructureTypeKHR type_;
  rhi::BottomLevelDesc bottom_level_desc_;
  rhi::TopLevelDesc top_level_desc_;
  bool is_compacted_ = false;
  BackedBuffer buffer_;
  vk::raii::AccelerationStructureKHR structure_ = nullptr;
  rhi::AccelerationStructureSizes sizes_;
  std::uint64_t address_ = 0;
  std::atomic<std::int64_t> built_instance_count_ = never_built;
};

/// A copy of `source`, which `handle` holds, in as little memory as it takes; waits for everything submitted. `source`
/// was built with BuildFlags::allow_compaction. Throws rhi::Error(invalid_argument) when it was never built.
rhi::AccelerationStructureHandle make_compacted(const rhi::AccelerationStructureHandle& handle,
                                                const AccelerationStructure& source, const std::string& label);

}  // namespace tandem::vulkan
