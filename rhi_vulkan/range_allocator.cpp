#include "rhi_vulkan/range_allocator.hpp"

#include <iterator>

namespace tandem::vulkan {

RangeAllocator::RangeAllocator(std::uint64_t size) : size_(size), free_{{0, size}} {}

std::optional<std::uint64_t> RangeAllocator::allocate(std::uint64_t size, std::uint64_t alignment) {
  auto best = free_.end();
  std::uint64_t best_offset = 0;
  for (auto range = free_.begin(); range != free_.end(); ++range) {
    const auto [begin, length] = *range;
    const std::uint64_t aligned = (begin + alignment - 1) & ~(alignment - 1);
    const std::uint64_t padding = aligned - begin;
    if (length < padding || length - padding < size) continue;
    if (best == free_.end() || length < best->second) {
      best = range;
      best_offset = aligned;
    }
  }
  if (best == free_.end()) return std::nullopt;

  const std::uint64_t begin = best->first;
  const std::uint64_t end = begin + best->second;
  free_.erase(best);
  if (best_offset > begin) free_.emplace(begin, best_offset - begin);
  if (best_offset + size < end) free_.emplace(best_offset + size, end - best_offset - size);
  return best_offset;
}

void RangeAllocator::free(std::uint64_t offset, std::uint64_t size) {
  const auto next = free_.lower_bound(offset);
  std::uint64_t begin = offset;
  std::uint64_t end = offset + size;
  if (next != free_.begin()) {
    const auto previous = std::prev(next);
    if (previous->first + previous->second == offset) {
      begin = previous->first;
      free_.erase(previous);
    }
  }
  if (next != free_.end() && next->first == end) {
    end += next->second;
    free_.erase(next);
  }
  free_.emplace(begin, end - begin);
}

bool RangeAllocator::empty() const noexcept { return free_.size() == 1 && free_.begin()->second == size_; }

}  // namespace tandem::vulkan
