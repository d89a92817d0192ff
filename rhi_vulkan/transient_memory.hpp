#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "rhi_vulkan/buffer.hpp"

namespace tandem::vulkan {

/// Memory for as long as one command list needs it, handed out piece after piece: staging of uploads, scratch of
/// builds.
class TransientMemory {
 public:
  struct Piece {
    vk::Buffer buffer;
    std::uint64_t offset = 0;          ///< in `buffer`
    std::byte* mapped = nullptr;       ///< on the host, for MemoryKind::upload
    std::uint64_t device_address = 0;  ///< for usage eShaderDeviceAddress; this is what `alignment` aligns
  };

  TransientMemory(vk::BufferUsageFlags usage, MemoryKind kind, std::string label);

  Piece allocate(Context& context, std::uint64_t size, std::uint64_t alignment);
  /// Bytes handed out since the beginning or the last reuse.
  std::uint64_t used() const noexcept { return used_; }
  /// Hands everything out again: the device has finished with it (a barrier stands in between).
  void reuse() noexcept;

 private:
  struct Chunk {
    BackedBuffer buffer;
    std::uint64_t size = 0;
    std::uint64_t device_address = 0;
  };

  vk::BufferUsageFlags usage_;
  MemoryKind kind_;
  std::string label_;
  std::vector<Chunk> chunks_;
  std::size_t current_ = 0;
  std::uint64_t cursor_ = 0;  // in the current chunk
  std::uint64_t used_ = 0;
};

}  // namespace tandem::vulkan
