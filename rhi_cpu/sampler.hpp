#pragma once

#include "rhi/sampler.hpp"
#include "rhi_cpu/device_state.hpp"
#include "rhi_cpu/kernel/abi.hpp"

namespace tandem::cpu {

class Sampler final : public rhi::Sampler {
 public:
  Sampler(DeviceStateHandle device, const rhi::SamplerDesc& desc);

  const DeviceState& device() const noexcept { return *device_; }
  const kernel::Sampler& view() const noexcept { return view_; }

 private:
  DeviceStateHandle device_;
  kernel::Sampler view_;
};

}  // namespace tandem::cpu
