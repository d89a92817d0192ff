#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tandem::cpu {

/// A module whose specialisation constants are frozen, with constants in place of each OpSpecConstantOp and
/// OpSpecConstantComposite; SPIRV-Tools folds those of 32-bit integers and booleans only, and its result can use a
/// constant before its declaration. Operations that are undefined give what kernel/components.hpp gives. An operation
/// that this does not know is left as it is.
std::vector<std::uint32_t> fold_constants(std::span<const std::uint32_t> spirv);

}  // namespace tandem::cpu
