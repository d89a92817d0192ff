#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

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

/// Submits what `record(commands)` records, behind everything submitted before, and keeps `resources` alive until it
/// has executed. Returns the submission's number.
template <typename Record>
std::uint64_t submit_commands(Context& context, const std::string& label, std::shared_ptr<const void> resources,
                              Record&& record) {
  struct InFlight {
    CommandBuffer commands;
    std::shared_ptr<const void> resources;
  };
  const auto in_flight =
      std::make_shared<InFlight>(InFlight{begin_command_buffer(context, label), std::move(resources)});
  const vk::raii::CommandBuffer& commands = in_flight->commands.handle;
  full_barrier(commands);
  record(commands);
  commands.end();
  return context.queue.submit(*commands, in_flight);
}

}  // namespace tandem::vulkan
