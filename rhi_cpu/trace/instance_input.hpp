#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

#include "rhi/acceleration_structure.hpp"
#include "rhi_cpu/kernel/trace.hpp"

/// What top levels are built from in host memory, and what both tracers read out of it.
namespace tandem::cpu {

/// An rhi::InstanceDesc, read.
struct InstanceInput {
  kernel::Instance instance;  ///< but for world_to_object, which is 0: each tracer has its own limits to an inverse
  rhi::InstanceFlags flags;
  std::uint32_t mask;
  std::uint64_t bottom_level_address;  ///< 0: inactive (Vulkan, "Inactive Primitives and Instances")
};

InstanceInput read_instance(const rhi::InstanceDesc& desc);

/// Throws rhi::Error, in the name of `label`, because instance `number` refers to an address without a bottom level.
[[noreturn]] void reject_address(const InstanceInput& input, std::size_t number, std::string_view label);

/// The bottom level of instance `number` by `lookup`; null when the instance is inactive. Throws as reject_address does
/// for an address that `lookup` does not know.
template <class BottomLevel>
const BottomLevel* find_bottom_level(const InstanceInput& input, std::size_t number,
                                     const std::function<const BottomLevel*(std::uint64_t)>& lookup,
                                     std::string_view label) {
  if (input.bottom_level_address == 0) return nullptr;
  const BottomLevel* found = lookup(input.bottom_level_address);
  if (found == nullptr) reject_address(input, number, label);
  return found;
}

/// Whether every triangle of an instance is opaque, unless the ray says otherwise.
/// @param bottom_level_is whether every triangle of its bottom level is
bool is_opaque(rhi::InstanceFlags flags, bool bottom_level_is);

}  // namespace tandem::cpu
