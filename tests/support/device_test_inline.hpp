#pragma once

#include <span>

namespace tandem::test {

template <typename T>
rhi::BufferHandle buffer_of(rhi::Device& device, const std::vector<T>& values, const std::string& label) {
  using rhi::BufferUsage;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(values));
  rhi::BufferHandle buffer =
      device.create_buffer({.size = bytes.size(),
                            .usage = BufferUsage::storage | BufferUsage::uniform |
                                     BufferUsage::acceleration_structure_input | BufferUsage::device_address,
                            .label = label});
  rhi::CommandListHandle list = device.create_command_list("upload " + label);
  list->upload(buffer, 0, bytes);
  device.submit(list)->wait();
  return buffer;
}

template <typename T>
std::vector<T> contents(rhi::Device& device, const rhi::BufferHandle& buffer, std::size_t count) {
  std::vector<T> values(count);
  device.download(buffer, 0, std::as_writable_bytes(std::span(values)));
  return values;
}

}  // namespace tandem::test
