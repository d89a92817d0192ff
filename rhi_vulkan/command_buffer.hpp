#pragma once

#include <string>

#include "rhi_vulkan/context.hpp"

namespace tandem::vulkan {

/// A Vulkan command buffer that is recorded and submitted once, with a pool of its own, so that any thread may record
/// it.
struct CommandBuffer {
  vk::raii::CommandPool pool = nullptr;
  vk::raii::CommandBuffer handle = nullptr;
};

/// A command buffer in the recording state.
CommandBuffer begin_command_buffer(const Context& context, const std::string& label);

/// Everything before is finished and its writes are visible to everything after, in this and in earlier submissions.
void full_barrier(const vk::raii::CommandBuffer& commands);

/// Transfers before are finished and their writes are visible to the host once the submission has executed.
void host_read_barrier(const vk::raii::CommandBuffer& commands);

}  // namespace tandem::vulkan
