#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "rhi/device.hpp"

/// Buffers and host memory in one call each, where nothing else needs to run meanwhile.
namespace tandem::rhi {

/// A buffer that holds the values, which are at least one. Waits for the upload. Throws Error.
template <typename T, std::size_t extent>
BufferHandle create_filled(Device& device, std::span<T, extent> values, BufferUsage usage, const std::string& label) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::span<const std::byte> bytes = std::as_bytes(values);
  BufferHandle buffer = device.create_buffer({.size = bytes.size(), .usage = usage, .label = label});
  const CommandListHandle list = device.create_command_list("upload of " + label);
  list->upload(buffer, 0, bytes);
  device.submit(list)->wait();
  return buffer;
}

/// The first `count` T of the buffer. Throws Error when it is too small.
template <typename T>
std::vector<T> read(Device& device, const BufferHandle& buffer, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> values(count);
  device.download(buffer, 0, std::as_writable_bytes(std::span(values)));
  return values;
}

}  // namespace tandem::rhi
