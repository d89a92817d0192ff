#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// What reflection needs beside SPIRV-Cross. Words of a valid module.
namespace tandem::rhi {

/// The module with undefined values in place of null arrays and structures. SPIRV-Cross refuses a null array whose
/// length is a specialisation constant, and reflection asks for none of these values.
std::vector<std::uint32_t> without_composite_nulls(std::span<const std::uint32_t> spirv);

/// Variables of the module whose pointers are values: an OpPhi picks them, or they are returned, stored or compared.
/// SPIRV-Cross does not see that a shader uses them.
std::vector<std::uint32_t> variables_used_as_values(std::span<const std::uint32_t> spirv);

}  // namespace tandem::rhi
