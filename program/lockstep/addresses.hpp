#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "program/lockstep/walk.hpp"

namespace tandem::program {

/// Bytes of a variable that is a block.
struct BlockRange {
  std::uint32_t variable = 0;  ///< its id
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
};

/// Where a pointer points, by the offsets and strides that the module declares. Nothing for a pointer into anything but
/// a uniform or storage buffer that is no array of them, and where an index is not known.
/// @param walk stands at an instruction that uses the pointer
std::optional<BlockRange> block_range(const Walk& walk, std::uint32_t pointer);

/// The set and the binding of a variable, where it has both.
struct DescriptorPlace {
  std::uint32_t set = 0, binding = 0;
  bool operator==(const DescriptorPlace&) const = default;
};
std::optional<DescriptorPlace> descriptor_of(const Module& module, std::uint32_t variable);

}  // namespace tandem::program
