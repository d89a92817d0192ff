#pragma once

#include <cstdint>

namespace tandem::cpu {

/// Ids of image operands, 0 for those that an instruction does not have.
struct ImageOperands {
  std::uint32_t detail = 0;  ///< Lod
  std::uint32_t dx = 0, dy = 0;
  std::uint32_t offset = 0;
  std::uint32_t offsets = 0;  ///< four of them
  std::uint32_t least_detail = 0;
};

}  // namespace tandem::cpu
