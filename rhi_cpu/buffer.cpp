#include "rhi_cpu/buffer.hpp"

#include "rhi/error.hpp"
#include "rhi/validation.hpp"

namespace tandem::cpu {

Buffer::Buffer(DeviceStateHandle device, const rhi::BufferDesc& desc) : rhi::Buffer(desc), device_(std::move(device)) {
  rhi::validation::check(desc);
  memory_ = allocate_host_memory(desc.size, desc.label, "a buffer");
}

std::uint64_t Buffer::device_address() const {
  using rhi::BufferUsage;
  if (!has(desc().usage, BufferUsage::device_address) && !has(desc().usage, BufferUsage::acceleration_structure_input))
    throw rhi::Error(rhi::ErrorCode::invalid_argument, desc().label,
                     "a buffer without the usage device_address or acceleration_structure_input has no address");
  return reinterpret_cast<std::uintptr_t>(data());
}

}  // namespace tandem::cpu
