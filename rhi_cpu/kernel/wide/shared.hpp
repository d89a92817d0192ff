#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "rhi_cpu/kernel/memory.hpp"
#include "rhi_cpu/kernel/wide/memory.hpp"
#include "rhi_cpu/kernel/wide/texels.hpp"

/// Numbers in shared variables, at byte offsets of each lane's own.
namespace tandem::kernel {

/// index_inside() of every lane.
inline Words index_inside(std::uint32_t count, const Words& indices) {
  return kernel::select(indices < Words(count), indices, Words(0u));
}

/// At once where the lanes' numbers are neighbours, or one and the same.
/// @param mask not empty
template <typename T>
inline Lanes<T> load_shared(Mask mask, const std::byte* variable, const Words& offsets) {
  Lanes<T> numbers;
  const std::uint32_t bits = bits_of(mask);
  if (bits == all_bits && are_neighbours(offsets, sizeof(T))) {
    std::memcpy(&numbers.of_lane, variable + offsets[0], sizeof(numbers.of_lane));
    return numbers;
  }
  // Where no lane executes, there is no offset.
  const std::uint32_t any = offsets[std::countr_zero(bits)];
  const Words safe = bits == all_bits ? offsets : kernel::select(mask, offsets, Words(any));
  if (bits_of(safe == Words(any)) == all_bits) return Lanes<T>(load<T>(variable + any));
#pragma GCC unroll 32
  for (int i = 0; i < lane_count; ++i) numbers.set(i, load<T>(variable + safe[i]));
  return numbers;
}

/// In the order of the lanes.
template <typename T>
inline void store_shared(Mask mask, std::byte* variable, const Words& offsets, const Lanes<T>& numbers) {
  if (bits_of(mask) == all_bits && are_neighbours(offsets, sizeof(T))) {
    std::memcpy(variable + offsets[0], &numbers.of_lane, sizeof(numbers.of_lane));
    return;
  }
  for (const int lane : EachLane(mask)) store<T>(variable + offsets[lane], numbers[lane]);
}

}  // namespace tandem::kernel
