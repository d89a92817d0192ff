#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "rhi_vulkan/physical_device.hpp"

namespace tandem::vulkan {

/// Throws rhi::Error(unsupported) when the module's SPIR-V is newer than Vulkan 1.2 takes, or when it declares a
/// capability that no feature the device was created with allows; the error names it.
void check_shader_capabilities(std::span<const std::uint32_t> spirv, const PhysicalDevice& device,
                               std::string_view label);

}  // namespace tandem::vulkan
