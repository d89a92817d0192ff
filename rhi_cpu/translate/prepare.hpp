#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rhi/compute_pipeline.hpp"

namespace tandem::cpu {

/// The module as the printer wants it: valid, everything in it supported, specialisation constants replaced by plain
/// constants (array lengths, workgroup size and constant expressions follow), undefined values replaced by zero.
/// Throws rhi::Error as translate() does.
std::vector<std::uint32_t> prepare(std::span<const std::uint32_t> spirv, const std::string& label,
                                   std::span<const rhi::SpecializationValue> specialization);

}  // namespace tandem::cpu
