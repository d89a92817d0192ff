#include "rhi_vulkan/transient_memory.hpp"

#include <algorithm>
#include <utility>

namespace tandem::vulkan {
namespace {

constexpr std::uint64_t usual_chunk_size = 1 << 20;

}  // namespace

TransientMemory::TransientMemory(vk::BufferUsageFlags usage, MemoryKind kind, std::string label)
    : usage_(usage), kind_(kind), label_(std::move(label)) {}

TransientMemory::Piece TransientMemory::allocate(Context& context, std::uint64_t size, std::uint64_t alignment) {
  const auto aligned_cursor = [&](const Chunk& chunk, std::uint64_t cursor) {
    const std::uint64_t address = chunk.device_address + cursor;
    return ((address + alignment - 1) & ~(alignment - 1)) - chunk.device_address;
  };
  while (current_ < chunks_.size() && aligned_cursor(chunks_[current_], cursor_) + size > chunks_[current_].size) {
    ++current_;
    cursor_ = 0;
  }
  if (current_ == chunks_.size()) {
    Chunk chunk;
    chunk.size = std::max(size + alignment, usual_chunk_size);
    chunk.buffer = make_backed_buffer(context, chunk.size, usage_, kind_, label_);
    if (usage_ & vk::BufferUsageFlagBits::eShaderDeviceAddress)
      chunk.device_address = device_address(context, chunk.buffer);
    chunks_.push_back(std::move(chunk));
    cursor_ = 0;
  }
  const Chunk& chunk = chunks_[current_];
  const std::uint64_t offset = aligned_cursor(chunk, cursor_);
  cursor_ = offset + size;
  used_ += size;
  std::byte* const mapped = chunk.buffer.memory.mapped();
  return {.buffer = *chunk.buffer.handle,
          .offset = offset,
          .mapped = mapped == nullptr ? nullptr : mapped + offset,
          .device_address = chunk.device_address + offset};
}

void TransientMemory::reuse() noexcept {
  current_ = 0;
  cursor_ = 0;
  used_ = 0;
}

}  // namespace tandem::vulkan
