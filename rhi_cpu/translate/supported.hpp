#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <spirv_cross/spirv.hpp>

namespace tandem::cpu {

/// What the translator handles, by SPIR-V's names, sorted.
struct ShaderSupport {
  std::vector<std::string> storage_classes;
  std::vector<std::string> built_ins;
  std::vector<std::string> execution_models;
  std::vector<std::string> execution_modes;
  std::vector<std::string> decorations;
};
ShaderSupport shader_support();

/// SPIR-V's numbers, ascending.
std::vector<std::uint32_t> supported_capabilities();

/// Whether the translator handles an instruction; some uses of it may be refused all the same.
bool is_supported(spv::Op op);

/// Walks the raw words and names everything that the translator does not handle: capabilities, extended instruction
/// sets, execution models and modes, storage classes, decorations, built-ins, instructions and extended instructions.
/// Nothing unknown gets past it. Throws rhi::Error(invalid_argument), in the name of `label`, for truncated words.
std::vector<std::string> unsupported_features(std::span<const std::uint32_t> spirv, const std::string& label);

/// Whether the module may have something that depends on the size of a subgroup.
bool declares_subgroups(std::span<const std::uint32_t> spirv);

bool declares_ray_queries(std::span<const std::uint32_t> spirv);

/// Throws rhi::Error(unsupported) with all that unsupported_features() finds.
void check_supported(std::span<const std::uint32_t> spirv, const std::string& label);

}  // namespace tandem::cpu
