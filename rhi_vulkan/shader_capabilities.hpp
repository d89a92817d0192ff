#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rhi_vulkan/physical_device.hpp"

namespace tandem::vulkan {

/// SPIR-V's numbers of the capabilities that some Vulkan device may offer, ascending.
std::vector<std::uint32_t> known_capabilities();

/// Those that this one offers.
std::vector<std::uint32_t> offered_capabilities(const PhysicalDevice& device);

/// What the module needs and no feature that the device was created with allows, "the SPIR-V capability Float16" for
/// example: its version, the capabilities and extensions that it declares, and initialized workgroup memory.
std::vector<std::string> missing_capabilities(std::span<const std::uint32_t> spirv, const PhysicalDevice& device);

/// Throws rhi::Error(unsupported), in the name of `label`, with all that missing_capabilities() finds.
void check_shader_capabilities(std::span<const std::uint32_t> spirv, const PhysicalDevice& device,
                               std::string_view label);

}  // namespace tandem::vulkan
