#pragma once

#include <string>

namespace tandem::cpu {

/// Throws rhi::Error(unsupported): "`label`: `what` is not supported by the CPU device".
[[noreturn]] void refuse(const std::string& label, const std::string& what);

}  // namespace tandem::cpu
