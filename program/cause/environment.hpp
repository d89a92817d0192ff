#pragma once

#include <cstdint>

#include "program/cause/number/range.hpp"
#include "program/record/module.hpp"

/// What a module says about the floats of an instruction: decorations, and execution modes of the entry point.
namespace tandem::program {

bool is_decorated(const Module& module, std::uint32_t id, spv::Decoration decoration);

/// The GLSL.std.450 instruction of an OpExtInst; 0 for any other instruction.
std::uint32_t glsl_instruction(const Module& module, const Instruction& instruction);

/// With what floats of this width are computed by the instruction: VK_KHR_shader_float_controls, RelaxedPrecision.
Rules rules_of(const Module& module, const Instruction& instruction, std::uint32_t width);

}  // namespace tandem::program
