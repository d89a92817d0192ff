#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rhi/bind_group.hpp"
#include "rhi_cpu/device_state.hpp"
#include "rhi_cpu/kernel/abi.hpp"

namespace tandem::cpu {

class BindGroup final : public rhi::BindGroup {
 public:
  BindGroup(DeviceStateHandle device, const rhi::BindGroupDesc& desc);

  const DeviceState& device() const noexcept { return *device_; }

 private:
  DeviceStateHandle device_;
};

/// The resources of the groups in the order in which the kernel wants them. To be called when the dispatch executes,
/// for a top level's view changes when it is built. Throws Error for a top level that is not built; `label` is the
/// pipeline's.
std::vector<kernel::Resource> resource_table(const kernel::KernelInfo& kernel,
                                             std::span<const std::shared_ptr<BindGroup>> groups,
                                             const std::string& label);

}  // namespace tandem::cpu
