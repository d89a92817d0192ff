#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <spirv_cross/spirv.hpp>

namespace tandem::cpu {

/// Throws rhi::Error(unsupported): "`label`: `what` is not supported by the CPU device".
[[noreturn]] void refuse(const std::string& label, const std::string& what);

/// Whether the translator handles an instruction; some uses of it may be refused all the same.
bool is_supported(spv::Op op);

/// Walks the raw words and throws rhi::Error(unsupported) with the name of the first thing that the translator does not
/// handle: a capability, extended instruction set, execution model or mode, storage class, decoration, built-in,
/// instruction or extended instruction. Nothing unknown gets past it. The words must be a valid module.
void check_supported(std::span<const std::uint32_t> spirv, const std::string& label);

}  // namespace tandem::cpu
