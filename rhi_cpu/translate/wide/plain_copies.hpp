#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tandem::cpu {

/// A valid module with OpLoad and OpStore in place of OpCopyMemory, so that spirv-opt and the wide form see values.
std::vector<std::uint32_t> with_plain_copies(std::span<const std::uint32_t> spirv);

}  // namespace tandem::cpu
