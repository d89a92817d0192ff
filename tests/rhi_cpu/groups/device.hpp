#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rhi/device.hpp"

/// Compute shaders on CPU devices with subgroups of a chosen size.
namespace tandem::cpu::test {

using Words = std::vector<std::uint32_t>;

rhi::DeviceHandle device_with(std::uint32_t subgroup_size);

/// Runs workgroups of the shader over one buffer of these words and returns what is in it then.
Words run(rhi::Device& device, const std::vector<std::uint32_t>& spirv, const Words& words,
          std::uint32_t workgroups = 1);
Words run(rhi::Device& device, const std::string& glsl, const Words& words, std::uint32_t workgroups = 1);

}  // namespace tandem::cpu::test
