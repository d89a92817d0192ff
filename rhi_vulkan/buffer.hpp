#pragma once

#include "rhi/buffer.hpp"
#include "rhi_vulkan/context.hpp"

namespace tandem::vulkan {

/// Memory for a buffer or an image. Throws rhi::Error(out_of_memory) naming `label`, after having let go of what
/// finished submissions held.
MemoryAllocation allocate(Context& context, const vk::MemoryRequirements& requirements, MemoryKind kind,
                          const std::string& label);

/// A VkBuffer and the memory under it.
struct BackedBuffer {
  MemoryAllocation memory;
  vk::raii::Buffer handle = nullptr;  // destroyed before its memory
};

/// Throws as `allocate`.
BackedBuffer make_backed_buffer(Context& context, std::uint64_t size, vk::BufferUsageFlags usage, MemoryKind kind,
                                const std::string& label);

/// Of a buffer with usage eShaderDeviceAddress.
std::uint64_t device_address(const Context& context, const BackedBuffer& buffer);

class Buffer final : public rhi::Buffer {
 public:
  Buffer(ContextHandle context, const rhi::BufferDesc& desc);

  std::uint64_t device_address() const override;
  const ContextHandle& context() const noexcept { return context_; }
  vk::Buffer handle() const { return *buffer_.handle; }
  /// device_address(), which the usage indirect has too.
  std::uint64_t address() const;

 private:
  ContextHandle context_;
  BackedBuffer buffer_;
};

}  // namespace tandem::vulkan
