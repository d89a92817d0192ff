#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "rhi_cpu/translate/translate_options.hpp"

/// SPIR-V to C++: one shader, of compute or of a ray tracing stage, becomes one C++20 translation unit that includes
/// headers of rhi_cpu/kernel/ and exports one function that returns its kernel::KernelInfo.
namespace tandem::cpu {

/// Raised whenever the same SPIR-V translates to other C++ than before.
inline constexpr std::uint32_t translator_version = 15;

struct Translation {
  std::string source;
};

/// Translates the shader in `spirv`. Floating-point operations keep their order and are never contracted;
/// integers wrap; every variable without an initialiser starts as zero.
/// @param label names the shader in errors
/// Throws rhi::Error: invalid_argument when the words are no valid SPIR-V module or a specialisation value names no
/// constant, unsupported with the name of the first instruction, capability, execution model, storage class, built-in,
/// decoration or extended instruction that the CPU device does not handle.
Translation translate(std::span<const std::uint32_t> spirv, const std::string& label,
                      const TranslateOptions& options = {});

}  // namespace tandem::cpu
