#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "program/record/module.hpp"

namespace tandem::program {

/// The module with NoContraction on every instruction that computes floats: what GLSL calls precise. Without it a
/// driver may fuse and rearrange arithmetic, so that a result depends on what else the shader does, as on recording.
std::vector<std::uint32_t> without_contraction(const Module& module);

/// Whether a driver may combine the instruction with others: it computes floats, and is not NoContraction.
bool may_be_contracted(const Module& module, const Instruction& instruction);

}  // namespace tandem::program
