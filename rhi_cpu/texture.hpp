#pragma once

#include <cstddef>
#include <span>

#include "rhi/texture.hpp"
#include "rhi_cpu/device_state.hpp"
#include "rhi_cpu/host_memory.hpp"
#include "rhi_cpu/kernel/abi.hpp"

namespace tandem::cpu {

/// Tightly packed texels in host memory.
class Texture final : public rhi::Texture {
 public:
  /// Throws Error(out_of_memory).
  Texture(DeviceStateHandle device, const rhi::TextureDesc& desc);

  const DeviceState& device() const noexcept { return *device_; }
  std::span<std::byte> texels() const noexcept { return {memory_.get(), static_cast<std::size_t>(size_in_bytes())}; }
  /// What a kernel sees: the `data` of its Resource.
  const kernel::Image& image() const noexcept { return image_; }

 private:
  DeviceStateHandle device_;
  HostMemory memory_;
  kernel::Image image_;
};

}  // namespace tandem::cpu
