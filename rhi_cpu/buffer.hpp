#pragma once

#include <cstddef>

#include "rhi/buffer.hpp"
#include "rhi_cpu/device_state.hpp"
#include "rhi_cpu/host_memory.hpp"

namespace tandem::cpu {

/// Host memory, aligned to a cache line.
class Buffer final : public rhi::Buffer {
 public:
  /// Throws Error(out_of_memory), always for more than the machine has.
  Buffer(DeviceStateHandle device, const rhi::BufferDesc& desc);

  std::uint64_t device_address() const override;

  const DeviceState& device() const noexcept { return *device_; }
  std::byte* data() const noexcept { return memory_.get(); }

 private:
  DeviceStateHandle device_;
  HostMemory memory_;
};

}  // namespace tandem::cpu
