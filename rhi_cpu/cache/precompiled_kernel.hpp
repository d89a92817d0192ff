#pragma once

#include <cstdint>
#include <span>

#include "rhi/pipeline.hpp"
#include "rhi_cpu/kernel/abi.hpp"

namespace tandem::cpu {

/// A kernel that the build has translated and compiled (tandem_add_shaders). The CPU device uses it for shader modules
/// of exactly these words that are specialised to the same values.
struct PrecompiledKernel {
  std::span<const std::uint32_t> spirv;
  kernel::EntryFunction entry;
  std::span<const rhi::SpecializationValue> specialization = {};  ///< constants that are not named have their defaults
};

}  // namespace tandem::cpu
