#include "rhi_cpu/buffer.hpp"

#include <unistd.h>

#include <new>

#include <fmt/format.h>

#include "rhi/error.hpp"
#include "rhi/validation.hpp"

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

void Buffer::Free::operator()(std::byte* memory) const { ::operator delete(memory, alignment); }

Buffer::Buffer(DeviceStateHandle device, const rhi::BufferDesc& desc) : rhi::Buffer(desc), device_(std::move(device)) {
  rhi::validation::check(desc);
  if (!exceeds_machine(desc.size))
    memory_.reset(static_cast<std::byte*>(::operator new(desc.size, alignment, std::nothrow)));
  if (memory_ == nullptr)
    throw rhi::Error(rhi::ErrorCode::out_of_memory, desc.label,
                     fmt::format("there is no memory for a buffer of {} bytes", desc.size));
}

std::uint64_t Buffer::device_address() const {
  using rhi::BufferUsage;
  if (!has(desc().usage, BufferUsage::device_address) && !has(desc().usage, BufferUsage::acceleration_structure_input))
    throw rhi::Error(rhi::ErrorCode::invalid_argument, desc().label,
                     "a buffer without the usage device_address or acceleration_structure_input has no address");
  return reinterpret_cast<std::uintptr_t>(data());
}

}  // namespace tandem::cpu
