#include "rhi_cpu/launch/stack_memory.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <new>

#include "rhi_cpu/launch/sanitized_switch.hpp"

namespace tandem::cpu {
namespace {

/// A cache line, and as many of them as a page of 4 KiB has.
constexpr std::size_t line = 64, lines = 64;

}  // namespace

StackMemory::StackMemory(std::size_t size, std::uint32_t number) {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  // An odd number of lines apart, so that neighbours lie far from each other and all lines take part.
  const std::size_t shift = number * std::size_t{13} % lines * line;
  size_ = (size + lines * line + page - 1) / page * page;
  mapped_ = size_ + page;
  void* mapping =
      ::mmap(nullptr, mapped_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_STACK, -1, 0);
  if (mapping == MAP_FAILED) throw std::bad_alloc();
  mapping_ = static_cast<std::byte*>(mapping);
  if (::mprotect(mapping_, page, PROT_NONE) != 0) {
    ::munmap(mapping_, mapped_);
    throw std::bad_alloc();
  }
  forget_frames(mapping_ + page, size_);
  top_ = mapping_ + mapped_ - shift;
  size_ -= shift;
}

StackMemory::~StackMemory() { ::munmap(mapping_, mapped_); }

}  // namespace tandem::cpu
