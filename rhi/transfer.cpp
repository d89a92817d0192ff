#include "rhi/transfer.hpp"

namespace tandem::rhi {

BufferHandle create_filled(Device& device, CommandList& list, std::span<const std::byte> bytes, BufferUsage usage,
                           const std::string& label) {
  BufferHandle buffer = device.create_buffer({.size = bytes.size(), .usage = usage, .label = label});
  list.upload(buffer, 0, bytes);
  return buffer;
}

BufferHandle create_filled(Device& device, std::span<const std::byte> bytes, BufferUsage usage,
                           const std::string& label) {
  const CommandListHandle list = device.create_command_list("upload of " + label);
  BufferHandle buffer = create_filled(device, *list, bytes, usage, label);
  device.submit(list);
  return buffer;
}

}  // namespace tandem::rhi
