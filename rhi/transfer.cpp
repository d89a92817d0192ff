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

TextureHandle create_filled(Device& device, std::span<const std::byte> bytes, const TextureDesc& desc) {
  TextureHandle texture = device.create_texture(desc);
  const CommandListHandle list = device.create_command_list("upload of " + desc.label);
  const BufferHandle staging = create_filled(device, *list, bytes, BufferUsage::none, "staging of " + desc.label);
  list->copy_to_texture({staging}, texture);
  device.submit(list);
  return texture;
}

std::vector<std::byte> read(Device& device, const TextureHandle& texture) {
  const std::string& label = texture->desc().label;
  const BufferHandle staging = device.create_buffer(
      {.size = texture->size_in_bytes(), .usage = BufferUsage::none, .label = "staging of " + label});
  const CommandListHandle list = device.create_command_list("download of " + label);
  list->copy_from_texture(texture, {staging});
  device.submit(list);
  return read<std::byte>(device, staging, static_cast<std::size_t>(texture->size_in_bytes()));
}

}  // namespace tandem::rhi
