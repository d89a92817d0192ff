#pragma once

#include <vector>

#include "rhi/device.hpp"
#include "rhi_cpu/precompiled_kernel.hpp"

/// The rhi on the CPU: shaders run as native code translated from their SPIR-V, rays are traced by Embree.
namespace tandem::cpu {

rhi::DeviceInfo device_info();

/// Submitted lists have executed when submit returns.
/// @param precompiled kernels of shaders that are a part of the program. Any other shader, or specialisation, is
/// compiled
///        by the system's C++ compiler when a pipeline is made of it, and cached on disk.
rhi::DeviceHandle create_device(const rhi::DeviceDesc& desc, std::vector<PrecompiledKernel> precompiled);

}  // namespace tandem::cpu
