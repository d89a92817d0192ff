#pragma once

#include <cstddef>
#include <cstdint>
#include <ranges>
#include <span>
#include <string>
#include <vector>

#include "rhi/device.hpp"

/// Values into new buffers and back, for callers that need no more than that.
namespace tandem::rhi {

/// A new buffer of these bytes, which are written when `list` executes. They are copied now, so they need not stay.
/// Throws Error; `bytes` must not be empty.
BufferHandle create_filled(Device& device, CommandList& list, std::span<const std::byte> bytes, BufferUsage usage,
                           const std::string& label);

/// The same by a submission of its own. It is not waited for: later submissions and Device::download find the values.
BufferHandle create_filled(Device& device, std::span<const std::byte> bytes, BufferUsage usage,
                           const std::string& label);

/// A new buffer of values that lie one after the other: a std::vector, std::array or std::span of them. (The bytes of
/// an array have a static extent, so they are converted, lest these call themselves.)
template <std::ranges::contiguous_range Values>
BufferHandle create_filled(Device& device, CommandList& list, const Values& values, BufferUsage usage,
                           const std::string& label) {
  return create_filled(device, list, std::span<const std::byte>(std::as_bytes(std::span(values))), usage, label);
}
template <std::ranges::contiguous_range Values>
BufferHandle create_filled(Device& device, const Values& values, BufferUsage usage, const std::string& label) {
  return create_filled(device, std::span<const std::byte>(std::as_bytes(std::span(values))), usage, label);
}

/// A new texture of these bytes: all levels, as Texture::size_in_bytes says. Not waited for.
TextureHandle create_filled(Device& device, std::span<const std::byte> bytes, const TextureDesc& desc);
template <std::ranges::contiguous_range Values>
TextureHandle create_filled(Device& device, const Values& values, const TextureDesc& desc) {
  return create_filled(device, std::span<const std::byte>(std::as_bytes(std::span(values))), desc);
}

/// Waits for everything submitted, then reads all levels of the texture.
std::vector<std::byte> read(Device& device, const TextureHandle& texture);

/// Waits for everything submitted, then reads `count` T from byte `offset` of the buffer on.
template <typename T>
std::vector<T> read(Device& device, const BufferHandle& buffer, std::size_t count, std::uint64_t offset = 0) {
  std::vector<T> values(count);
  device.download(buffer, offset, std::as_writable_bytes(std::span(values)));
  return values;
}

}  // namespace tandem::rhi
