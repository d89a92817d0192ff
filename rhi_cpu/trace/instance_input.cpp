#include "rhi_cpu/trace/instance_input.hpp"

#include <cstring>

#include <fmt/format.h>

#include "rhi/error.hpp"

namespace tandem::cpu {

InstanceInput read_instance(const rhi::InstanceDesc& desc) {
  InstanceInput input = {.instance = {},
                         .flags = static_cast<rhi::InstanceFlags>(desc.flags),
                         .mask = desc.mask,
                         .bottom_level_address = desc.blas_address};
  static_assert(sizeof(input.instance.object_to_world) == sizeof(desc.object_to_world));
  std::memcpy(input.instance.object_to_world, desc.object_to_world, sizeof(desc.object_to_world));
  input.instance.custom_index = desc.custom_index;
  input.instance.sbt_offset = desc.sbt_offset;
  return input;
}

void reject_address(const InstanceInput& input, std::size_t number, std::string_view label) {
  throw rhi::Error(rhi::ErrorCode::invalid_argument, label,
                   fmt::format("instance {} refers to the address {:#x}, where no bottom level is built", number,
                               input.bottom_level_address));
}

bool is_opaque(rhi::InstanceFlags flags, bool bottom_level_is) {
  if (rhi::has(flags, rhi::InstanceFlags::force_opaque)) return true;
  return !rhi::has(flags, rhi::InstanceFlags::force_no_opaque) && bottom_level_is;
}

}  // namespace tandem::cpu
