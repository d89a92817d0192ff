#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "rhi/device.hpp"
#include "rhi/error.hpp"
#include "rhi_cpu/bottom_level_registry.hpp"
#include "rhi_cpu/cache/kernel_store.hpp"
#include "rhi_cpu/cache/precompiled_kernel.hpp"
#include "rhi_cpu/launch/launch_fibres.hpp"
#include "rhi_cpu/tracer.hpp"
#include "rhi_cpu/workers.hpp"

namespace tandem::cpu {

/// What the objects of one device share and keep alive.
struct DeviceState {
  DeviceState(const rhi::DeviceDesc& desc, std::vector<PrecompiledKernel> precompiled);

  rhi::DeviceInfo info;
  Workers workers;
  Tracer tracer;
  std::chrono::milliseconds time_limit;  ///< of a launch; 0: none
  KernelStore kernels;
  FibrePool fibres;
  BottomLevelRegistry bottom_levels;
  std::mutex submission;  ///< held while a command list executes
};

using DeviceStateHandle = std::shared_ptr<DeviceState>;

/// The object behind an interface that is not null. Throws Error(invalid_argument) when it belongs to another device.
template <typename Own, typename Interface>
std::shared_ptr<Own> own(const std::shared_ptr<Interface>& object, const DeviceState& device, std::string_view label) {
  std::shared_ptr<Own> result = std::dynamic_pointer_cast<Own>(object);
  if (result == nullptr || &result->device() != &device)
    throw rhi::Error(rhi::ErrorCode::invalid_argument, label, "the object belongs to another device");
  return result;
}

}  // namespace tandem::cpu
