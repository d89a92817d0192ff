#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace tandem::rhi {

/// The module with nothing but the entry point `name`, its execution modes, and the functions that it calls; "" names
/// the only one. A module of one entry point stays as it is. Throws Error(invalid_argument), in the name of `label`,
/// where there is no such entry point, or several and no name. `spirv` must be valid.
std::vector<std::uint32_t> with_one_entry_point(std::span<const std::uint32_t> spirv, std::string_view name,
                                                std::string_view label);

}  // namespace tandem::rhi
