#include "rhi_vulkan/buffer.hpp"

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
  if (is_addressable(usage)) flags |= Usage::eShaderDeviceAddress;
  return flags;
}

MemoryAllocation allocate(Context& context, const vk::MemoryRequirements& requirements, MemoryKind kind) {
  try {
    return context.memory.allocate(requirements, kind);
  } catch (const rhi::Error& error) {
    if (error.code() != rhi::ErrorCode::out_of_memory) throw;
  }
  context.queue.release_finished();
  return context.memory.allocate(requirements, kind);
}

}  // namespace

BackedBuffer make_backed_buffer(Context& context, std::uint64_t size, vk::BufferUsageFlags usage, MemoryKind kind,
                                const std::string& label) {
  try {
    return translating_errors(label, "create a buffer of " + std::to_string(size) + " bytes", [&] {
      BackedBuffer buffer;
      buffer.handle = context.device.createBuffer({.size = size, .usage = usage});
      context.name(buffer.handle, label);
      buffer.memory = allocate(context, buffer.handle.getMemoryRequirements(), kind);
      buffer.handle.bindMemory(buffer.memory.memory(), buffer.memory.offset());
      return buffer;
    });
  } catch (const rhi::Error& error) {
    if (!error.label().empty() || label.empty()) throw;
    throw rhi::Error(error.code(), label, error.what());
  }
}

std::uint64_t device_address(const Context& context, const BackedBuffer& buffer) {
  return context.device.getBufferAddress({.buffer = *buffer.handle});
}

Buffer::Buffer(ContextHandle context, const rhi::BufferDesc& desc)
    : rhi::Buffer(desc),
      context_(std::move(context)),
      buffer_(make_backed_buffer(*context_, desc.size, usage_flags(desc.usage), MemoryKind::device, desc.label)) {}

std::uint64_t Buffer::device_address() const {
  if (!is_addressable(desc().usage))
    throw rhi::Error(rhi::ErrorCode::invalid_argument, desc().label,
                     "device_address() needs the usage device_address or acceleration_structure_input");
  return vulkan::device_address(*context_, buffer_);
}

}  // namespace tandem::vulkan
