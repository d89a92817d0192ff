#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <spirv_cross/spirv.hpp>

#include "rhi/compute_pipeline.hpp"

namespace tandem::cpu {

/// The module as the printer wants it: valid, everything in it supported, specialisation constants replaced by plain
/// constants (array lengths, workgroup size and constant expressions follow), undefined values replaced by zero.
/// Throws rhi::Error as translate() does.
std::vector<std::uint32_t> prepare(std::span<const std::uint32_t> spirv, const std::string& label,
                                   std::span<const rhi::SpecializationValue> specialization);

/// Stands in the header of a loop where its rounds are counted. No module that prepare() returns has this instruction.
inline constexpr spv::Op loop_mark = spv::OpLifetimeStart;

/// The words of prepare() for the wide form: values and OpPhi in place of variables where that is possible, small
/// modules with all functions inlined. No value changes by a bit.
std::vector<std::uint32_t> with_values_for_variables(std::span<const std::uint32_t> spirv, const std::string& label);

/// The words of prepare() with a loop_mark, without operands, in the header of each loop.
std::vector<std::uint32_t> with_marked_loops(std::span<const std::uint32_t> spirv);

}  // namespace tandem::cpu
