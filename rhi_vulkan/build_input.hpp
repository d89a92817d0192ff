#pragma once

#include <string>
#include <vector>

#include "rhi/acceleration_structure.hpp"
#include "rhi_vulkan/context.hpp"

namespace tandem::vulkan {

/// A desc in Vulkan's terms. Its buffers belong to the device.
struct BuildInput {
  vk::AccelerationStructureTypeKHR type = vk::AccelerationStructureTypeKHR::eBottomLevel;
  vk::BuildAccelerationStructureFlagsKHR flags;
  std::vector<vk::AccelerationStructureGeometryKHR> geometries;
  std::vector<vk::AccelerationStructureBuildRangeInfoKHR> ranges;  ///< one for each geometry
  std::vector<rhi::BufferHandle> buffers;                          ///< all that the build reads

  /// Of a build; points into this.
  vk::AccelerationStructureBuildGeometryInfoKHR info() const;
};

/// @param label of the structure, for errors
BuildInput build_input(const rhi::BottomLevelDesc& desc, const ContextHandle& context, const std::string& label);
BuildInput build_input(const rhi::TopLevelDesc& desc, const ContextHandle& context, const std::string& label);

}  // namespace tandem::vulkan
