#pragma once

#include <cstdint>
#include <span>

#include "rhi_cpu/kernel/abi.hpp"

namespace tandem::cpu {

/// A kernel that the build has translated and compiled (tandem_add_shaders), with default specialisation. The CPU
/// device uses it for shader modules of exactly these words.
struct PrecompiledKernel {
  std::span<const std::uint32_t> spirv;
  kernel::EntryFunction entry;
};

}  // namespace tandem::cpu
