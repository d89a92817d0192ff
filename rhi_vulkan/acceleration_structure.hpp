#pragma once

#include <vector>

#include "rhi/acceleration_structure.hpp"
#include "rhi_vulkan/buffer.hpp"

namespace tandem::vulkan {

/// A desc in Vulkan's terms. Its buffers belong to the device.
struct BuildInput {
  vk::AccelerationStructureTypeKHR type = vk::AccelerationStructureTypeKHR::eBottomLevel;
  std::vector<vk::AccelerationStructureGeometryKHR> geometries;
  std::vector<vk::AccelerationStructureBuildRangeInfoKHR> ranges;  ///< one for each geometry
  std::vector<rhi::BufferHandle> buffers;                          ///< all that the build reads

  /// Points into this.
  vk::AccelerationStructureBuildGeometryInfoKHR info() const;
};

/// @param label of the structure, for errors
BuildInput build_input(const rhi::BottomLevelDesc& desc, const ContextHandle& context, const std::string& label);
BuildInput build_input(const rhi::TopLevelDesc& desc, const ContextHandle& context, const std::string& label);

class AccelerationStructure final : public rhi::AccelerationStructure {
 public:
  AccelerationStructure(ContextHandle context, const rhi::BottomLevelDesc& desc);
  AccelerationStructure(ContextHandle context, const rhi::TopLevelDesc& desc);

  std::uint64_t device_address() const override { return address_; }
  rhi::AccelerationStructureSizes sizes() const override {
    return {.structure = 0, .build_scratch = scratch_size_, .update_scratch = 0};
  }
  const ContextHandle& context() const noexcept { return context_; }
  vk::AccelerationStructureKHR handle() const { return *structure_; }
  std::uint64_t scratch_size() const noexcept { return scratch_size_; }

  /// What it was created from, without the buffers that only a build reads; empty for the other level.
  const rhi::BottomLevelDesc& bottom_level_desc() const noexcept { return bottom_level_desc_; }
  const rhi::TopLevelDesc& top_level_desc() const noexcept { return top_level_desc_; }

 private:
  void create(const BuildInput& input);

  ContextHandle context_;
  rhi::BottomLevelDesc bottom_level_desc_;
  rhi::TopLevelDesc top_level_desc_;
  BackedBuffer buffer_;
  vk::raii::AccelerationStructureKHR structure_ = nullptr;
  std::uint64_t scratch_size_ = 0;
  std::uint64_t address_ = 0;
};

}  // namespace tandem::vulkan
