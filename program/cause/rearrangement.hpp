#pragma once

#include <optional>

#include "program/cause/permitted.hpp"

/// Vulkan, "Evaluation of Expressions": without NoContraction, implementations may combine and rearrange operations in
/// any way that is right for real numbers. Here are those that two instructions allow: a multiplication that is fused
/// with an addition, or a + b - a, which is b.
namespace tandem::program {

/// Whether other instructions may be combined with this one.
bool may_combine(const Module& module, const Instruction& instruction);

/// What a scalar of an id is without the rounding of the instruction that made it. Without the lookup, where that is a
/// multiplication: the interval that it was rounded from. Nothing where the instruction does not round, or must not be
/// combined.
std::optional<Range> unrounded(const Call& call, std::uint32_t id, std::size_t component, const Scalar& recorded);

}  // namespace tandem::program
