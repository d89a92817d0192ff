#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <spirv_cross/spirv.hpp>

namespace tandem::cpu {

/// A number or a boolean of a module: `bits` are the `width` lowest, 1 for a boolean; the others are zero.
struct ScalarConstant {
  std::uint64_t bits = 0;
  std::uint32_t width = 1;
};

/// The result, of `width` bits, of an operation that OpSpecConstantOp may have, on one component of each operand;
/// nothing for one that is unknown.
std::optional<ScalarConstant> fold_scalar(spv::Op op, std::span<const ScalarConstant> operands, std::uint32_t width);

}  // namespace tandem::cpu
