#pragma once

#include <cstdint>
#include <span>
#include <string_view>

/// The one gate that every SPIR-V module passes before anything parses it: neither SPIRV-Cross nor a driver looks at
/// what it is given.
namespace tandem::rhi {

/// The words are SPIR-V of this machine's byte order, and their instructions fill them. Throws Error(invalid_argument)
/// in the name of `label`.
void check_spirv_words(std::span<const std::uint32_t> words, std::string_view label);

/// The module is valid SPIR-V 1.6 for Vulkan 1.3, with scalar block layout, as SPIRV-Tools says. Throws
/// Error(invalid_argument) with the validator's first sentence.
void check_spirv(std::span<const std::uint32_t> words, std::string_view label);

}  // namespace tandem::rhi
