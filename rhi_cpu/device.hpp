#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "rhi/device.hpp"
#include "rhi_cpu/cache/precompiled_kernel.hpp"

/// The rhi on the CPU: shaders run as native code translated from their SPIR-V. Device "cpu" traces rays with Embree,
/// "cpu-exact" with the tracer of rhi_cpu/trace/exact, which is slow and does not round.
namespace tandem::cpu {

/// "cpu" and "cpu-exact".
std::span<const std::string_view> device_names();

/// Those, "cpu-scalar", which is "cpu" with DeviceDesc::lanes 1, and "cpu-wide", which runs all compute
/// shaders in lanes.
bool is_device_name(std::string_view name);

/// @param name one of device_names()
rhi::DeviceInfo device_info(std::string_view name);

/// Submitted lists have executed when submit returns. Throws Error(no_such_device) unless desc.name is one of
/// device_names().
/// @param precompiled kernels of shaders that are a part of the program. Any other shader, or specialisation, is
/// compiled
///        by the system's C++ compiler when a pipeline is made of it, and cached on disk.
rhi::DeviceHandle create_device(const rhi::DeviceDesc& desc, std::vector<PrecompiledKernel> precompiled);

}  // namespace tandem::cpu
