#pragma once

#include <cstddef>
#include <cstdint>

namespace tandem::cpu {

/// The stack of a fibre: memory that is there when it is touched first, below which a page ends the process that is
/// touched.
class StackMemory {
 public:
  /// @param size bytes at least
  /// @param number of the stack among those that run by turns: they begin at different distances from the ends of
  /// their pages, so that they do not share the few places that a cache has for one of them
  /// Throws std::bad_alloc.
  StackMemory(std::size_t size, std::uint32_t number);
  ~StackMemory();
  StackMemory(const StackMemory&) = delete;
  StackMemory& operator=(const StackMemory&) = delete;

  /// The end, where a stack begins; aligned to 64.
  void* top() const noexcept { return top_; }
  /// Bytes below it.
  std::size_t size() const noexcept { return size_; }

 private:
  std::byte* mapping_;
  std::size_t mapped_;
  void* top_;
  std::size_t size_;
};

}  // namespace tandem::cpu
