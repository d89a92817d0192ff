#pragma once

#include <deque>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rhi/bind_group.hpp"
#include "rhi_cpu/device_state.hpp"
#include "rhi_cpu/kernel/abi.hpp"

namespace tandem::cpu {

class TopLevelStructure;

class BindGroup final : public rhi::BindGroup {
 public:
  BindGroup(DeviceStateHandle device, const rhi::BindGroupDesc& desc);

  /// One element of one binding.
  struct Bound {
    std::uint32_t binding;
    std::uint32_t element;
    kernel::Resource resource;                           ///< of an acceleration structure: empty
    std::shared_ptr<const TopLevelStructure> structure;  ///< looked at when the group is used: it may be rebuilt
  };

  const DeviceState& device() const noexcept { return *device_; }
  std::span<const Bound> bound() const noexcept { return bound_; }

 private:
  Bound bind(const rhi::BindGroupEntry& entry);

  DeviceStateHandle device_;
  std::vector<Bound> bound_;
  // What resources point at; a deque never moves its elements.
  std::deque<kernel::Image> images_;
  std::deque<kernel::SampledImage> sampled_images_;
};

/// What a kernel's Dispatch::resources points at, and what those point at.
struct ResourceTable {
  std::vector<kernel::Resource> resources;
  std::vector<std::vector<kernel::Resource>> unsized_arrays;
};

/// The resources of the groups in the order in which the kernel wants them. To be called when the dispatch executes,
/// for a top level's view changes when it is built. Throws Error for a top level that is not built; `label` is the
/// pipeline's.
ResourceTable resource_table(const kernel::KernelInfo& kernel, std::span<const std::shared_ptr<BindGroup>> groups,
                             const std::string& label);

}  // namespace tandem::cpu
