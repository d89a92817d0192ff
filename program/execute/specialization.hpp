#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rhi/pipeline.hpp"
#include "rhi/shader_module.hpp"

namespace tandem::program {

/// The words of the module with the values as defaults of its specialisation constants. Throws
/// rhi::Error(invalid_argument), in the module's name, for a constant that it does not declare.
std::vector<std::uint32_t> specialized(const rhi::ShaderModule& module,
                                       std::span<const rhi::SpecializationValue> values);

}  // namespace tandem::program
