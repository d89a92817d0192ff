#pragma once

#include <cstdint>
#include <string>

namespace tandem::cpu {

/// Where a pointer into a buffer points, and how the memory there is laid out beyond what its type says.
struct Address {
  std::string bytes;                   ///< C++ expression of type std::byte*
  std::string resource;                ///< C++ expression of the kernel::Resource, "" where it has none
  std::string data = {};               ///< where the memory begins that `bytes` points into, "" where nobody knows
  std::string size = {};               ///< and how many bytes it has
  std::uint32_t offset = 0;            ///< constant part of the distance to `bytes`
  std::uint32_t matrix_stride = 0;     ///< of the matrices there
  std::uint32_t component_stride = 0;  ///< of the vector there, 0: tight
  std::uint32_t array_stride = 0;      ///< of the array that the place is an element of, 0: of none, or nobody knows
  bool row_major = false;
  bool varies = false;   ///< wide form: `bytes` are kernel::Addresses
  bool by_lane = false;  ///< wide form: `bytes` and `resource` are of the lane `lane`
};

}  // namespace tandem::cpu
