#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/cause/judgement.hpp"
#include "program/record/module.hpp"

/// Whether two devices may disagree about an instruction that had the same operands on both.
namespace tandem::program {

/// @param operands by Instruction::used_ids; nothing for what has no recorded value: pointers, images, labels
/// @param a, b     the two results, which differ in a bit
/// @param lookup  values of other ids, at the same time: the operands of a multiplication that may be fused with an
///                addition. Without it such an addition may err by what the multiplication may.
/// Instructions whose operands do not determine the result (loads, atomics, images, rays, subgroup operations) are a
/// mismatch of which `wrong` is unknown: the caller, who knows memory and rays, decides about them.
Judgement judge(const Module& module, const Instruction& instruction,
                std::span<const std::optional<RecordedWords>> operands, const RecordedWords& a, const RecordedWords& b,
                const ValueLookup& lookup = {});

}  // namespace tandem::program
