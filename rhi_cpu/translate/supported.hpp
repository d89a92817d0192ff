#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace tandem::cpu {

/// Walks the raw words and throws rhi::Error(unsupported) with the name of the first thing that the translator does not
/// handle: a capability, extended instruction set, execution model or mode, storage class, decoration, built-in,
/// instruction or extended instruction. Nothing unknown gets past it. The words must be a valid module.
void check_supported(std::span<const std::uint32_t> spirv, const std::string& label);

/// The operation that an OpSpecConstantOp applies, for example "IAdd".
std::string folded_operation_name(std::span<const std::uint32_t> instruction);

}  // namespace tandem::cpu
