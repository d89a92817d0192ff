#include "rhi_vulkan/command_buffer.hpp"

#include <utility>
#include <vector>

namespace tandem::vulkan {

CommandBuffer begin_command_buffer(const Context& context, const std::string& label) {
  return translating_errors(label, "begin a command list", [&] {
    CommandBuffer buffer;
    buffer.pool = context.device.createCommandPool(
        {.flags = vk::CommandPoolCreateFlagBits::eTransient, .queueFamilyIndex = context.queue.family()});
    buffer.handle = std::move(
        context.device
            .allocateCommandBuffers(
                {.commandPool = *buffer.pool, .level = vk::CommandBufferLevel::ePrimary, .commandBufferCount = 1})
            .front());
    context.name(buffer.handle, label);
    // A list may be submitted again before it has executed.
    buffer.handle.begin({.flags = vk::CommandBufferUsageFlagBits::eSimultaneousUse});
    return buffer;
  });
}

void full_barrier(const vk::raii::CommandBuffer& commands) {
  const vk::MemoryBarrier barrier = {
      .srcAccessMask = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite,
      .dstAccessMask = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite};
  commands.pipelineBarrier(vk::PipelineStageFlagBits::eAllCommands, vk::PipelineStageFlagBits::eAllCommands, {},
                           barrier, nullptr, nullptr);
}

void host_read_barrier(const vk::raii::CommandBuffer& commands) {
  const vk::MemoryBarrier barrier = {.srcAccessMask = vk::AccessFlagBits::eTransferWrite,
                                     .dstAccessMask = vk::AccessFlagBits::eHostRead};
  commands.pipelineBarrier(vk::PipelineStageFlagBits::eTransfer, vk::PipelineStageFlagBits::eHost, {}, barrier, nullptr,
                           nullptr);
}

}  // namespace tandem::vulkan
