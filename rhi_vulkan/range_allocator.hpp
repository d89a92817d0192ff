#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace tandem::vulkan {

/// Hands out ranges of [0, size): best fit, neighbours merged when they come back. Counts bytes only, touches no
/// memory.
class RangeAllocator {
 public:
  explicit RangeAllocator(std::uint64_t size);

  /// The offset of `size` > 0 free bytes at a multiple of `alignment` (a power of two); nothing when none fit.
  std::optional<std::uint64_t> allocate(std::uint64_t size, std::uint64_t alignment);
  /// Gives back exactly what one allocate returned.
  void free(std::uint64_t offset, std::uint64_t size);

  bool empty() const noexcept;
  std::uint64_t size() const noexcept { return size_; }

 private:
  std::uint64_t size_;
  std::map<std::uint64_t, std::uint64_t> free_;  // offset to size
};

}  // namespace tandem::vulkan
