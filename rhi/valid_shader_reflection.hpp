#pragma once

#include "rhi/shader_reflection.hpp"

namespace tandem::rhi {

/// reflect() of words that have passed the validator, or were made from such words. Anything
/// else may crash the parser.
ShaderReflection reflect_valid(std::span<const std::uint32_t> spirv, std::string_view label);

}  // namespace tandem::rhi
