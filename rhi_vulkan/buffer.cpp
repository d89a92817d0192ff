#include "rhi_vulkan/buffer.hpp"

#include <algorithm>
#include <utility>

namespace tandem::vulkan {
namespace {

bool is_addressable(rhi::BufferUsage usage) {
  return has(usage, rhi::BufferUsage::device_address) || has(usage, rhi::BufferUsage::acceleration_structure_input);
}

vk::BufferUsageFlags usage_flags(rhi::BufferUsage usage) {
  using Usage = vk::BufferUsageFlagBits;
  vk::BufferUsageFlags flags = Usage::eTransferSrc | Usage::eTransferDst;
  if (has(usage, rhi::BufferUsage::storage)) flags |= Usage::eStorageBuffer;
  if (has(usage, rhi::BufferUsage::uniform)) flags |= Usage::eUniformBuffer;
  if (has(usage, rhi::BufferUsage::acceleration_structure_input))
    flags |= Usage::eAccelerationStructureBuildInputReadOnlyKHR;
  if (has(usage, rhi::BufferUsage::indirect)) flags |= Usage::eIndirectBuffer;
  if (has(usage, rhi::BufferUsage::uniform_texels)) flags |= Usage::eUniformTexelBuffer;
  if (has(usage, rhi::BufferUsage::storage_texels)) flags |= Usage::eStorageTexelBuffer;
  if (is_addressable(usage) || has(usage, rhi::BufferUsage::indirect)) flags |= Usage::eShaderDeviceAddress;
  return flags;
}

/// A position of three 16-bit components is given to Vulkan as four, so a build may read two bytes beyond the last.
std::uint64_t padded_size(const rhi::BufferDesc& desc) {
  constexpr std::uint64_t fourth_component = 2;
  const bool is_input = has(desc.usage, rhi::BufferUsage::acceleration_structure_input);
  return is_input ? std::max(desc.size, desc.size + fourth_component) : desc.size;
}

}  // namespace

MemoryAllocation allocate(Context& context, const vk::MemoryRequirements& requirements, MemoryKind kind,
                          const std::string& label) {
  try {
    return context.memory.allocate(requirements, kind);
  } catch (const rhi::Error& error) {
    if (error.code() != rhi::ErrorCode::out_of_memory) throw rhi::Error(error.code(), label, error.what());
  }
  context.queue.release_finished();
  try {
    return context.memory.allocate(requirements, kind);
  } catch (const rhi::Error& error) {
    throw rhi::Error(error.code(), label, error.what());
  }
}

BackedBuffer make_backed_buffer(Context& context, std::uint64_t size, vk::BufferUsageFlags usage, MemoryKind kind,
                                const std::string& label) {
  return translating_errors(label, "create a buffer of " + std::to_string(size) + " bytes", [&] {
    BackedBuffer buffer;
    buffer.handle = context.device.createBuffer({.size = size, .usage = usage});
    context.name(buffer.handle, label);
    buffer.memory = allocate(context, buffer.handle.getMemoryRequirements(), kind, label);
    buffer.handle.bindMemory(buffer.memory.memory(), buffer.memory.offset());
    return buffer;
  });
}

std::uint64_t device_address(const Context& context, const BackedBuffer& buffer) {
  return context.device.getBufferAddress({.buffer = *buffer.handle});
}

Buffer::Buffer(ContextHandle context, const rhi::BufferDesc& desc)
    : rhi::Buffer(desc),
      context_(std::move(context)),
      buffer_(
          make_backed_buffer(*context_, padded_size(desc), usage_flags(desc.usage), MemoryKind::device, desc.label)) {}

std::uint64_t Buffer::device_address() const {
  if (!is_addressable(desc().usage))
    throw rhi::Error(rhi::ErrorCode::invalid_argument, desc().label,
                     "device_address() needs the usage device_address or acceleration_structure_input");
  return address();
}

std::uint64_t Buffer::address() const { return vulkan::device_address(*context_, buffer_); }

}  // namespace tandem::vulkan
