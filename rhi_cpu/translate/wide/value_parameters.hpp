#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tandem::cpu {

/// A valid module in which functions take by value what they take by pointer and only read, as front ends pass every
/// parameter: so spirv-opt can put values in place of the variables that the pointers lead to.
std::vector<std::uint32_t> with_value_parameters(std::span<const std::uint32_t> spirv);

}  // namespace tandem::cpu
