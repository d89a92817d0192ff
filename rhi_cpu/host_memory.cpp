#include "rhi_cpu/host_memory.hpp"

#include <unistd.h>

#include <new>

#include <fmt/format.h>

#include "rhi/error.hpp"

namespace tandem::cpu {
namespace {

constexpr std::align_val_t alignment{64};

/// Linux promises memory that it does not have and ends the program when it is used, so what can never fit is refused.
bool exceeds_machine(std::uint64_t size) {
  const long pages = ::sysconf(_SC_PHYS_PAGES);
  const long page_size = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && page_size > 0 && size / static_cast<std::uint64_t>(page_size) > static_cast<std::uint64_t>(pages);
}

}  // namespace

void HostMemoryFree::operator()(std::byte* memory) const { ::operator delete(memory, alignment); }

HostMemory allocate_host_memory(std::uint64_t size, std::string_view label, std::string_view what) {
  HostMemory memory;
  if (!exceeds_machine(size))
    memory.reset(static_cast<std::byte*>(::operator new(static_cast<std::size_t>(size), alignment, std::nothrow)));
  if (memory == nullptr)
    throw rhi::Error(rhi::ErrorCode::out_of_memory, label,
                     fmt::format("there is no memory for {} of {} bytes", what, size));
  return memory;
}

}  // namespace tandem::cpu
