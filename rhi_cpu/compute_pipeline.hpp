#pragma once

#include "rhi/compute_pipeline.hpp"
#include "rhi_cpu/cache/kernel_store.hpp"
#include "rhi_cpu/device_state.hpp"

namespace tandem::cpu {

/// The kernel of a shader, loaded.
class ComputePipeline final : public rhi::ComputePipeline {
 public:
  /// Throws what KernelStore::kernel does.
  ComputePipeline(DeviceStateHandle device, const rhi::ComputePipelineDesc& desc);

  const DeviceState& device() const noexcept { return *device_; }
  const kernel::KernelInfo& kernel() const noexcept { return *kernel_.info; }

 private:
  DeviceStateHandle device_;
  Kernel kernel_;
};

}  // namespace tandem::cpu
