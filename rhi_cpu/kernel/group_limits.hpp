#pragma once

#include <cstdint>

/// What a workgroup of a kernel has.
namespace tandem::kernel {

/// Bytes of shared variables.
inline constexpr std::uint32_t max_workgroup_memory = 64u << 10;

/// Invocations of a subgroup where nobody asks for another number: a power of two up to max_subgroup_size.
inline constexpr std::uint32_t default_subgroup_size = 8;
inline constexpr std::uint32_t max_subgroup_size = 32;

}  // namespace tandem::kernel
