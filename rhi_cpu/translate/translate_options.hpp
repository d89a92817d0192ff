#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "rhi/pipeline.hpp"
#include "rhi_cpu/kernel/group_limits.hpp"

namespace tandem::cpu {

struct TranslateOptions {
  /// Values of specialisation constants, baked in; the others keep their defaults.
  std::span<const rhi::SpecializationValue> specialization = {};
  /// The exported function, extern "C" const tandem::kernel::KernelInfo* entry_symbol().
  std::string entry_symbol = "tandem_kernel";
  /// Accesses outside of buffers, images, descriptor arrays and the shader's own arrays read zero and write nothing.
  /// Buffer references and pointers as values are not checked.
  bool robust = false;
  /// Loops look at kernel::Dispatch::watch.
  bool watched = false;
  /// gl_SubgroupSize: 1, 2, 4, 8, 16 or 32.
  std::uint32_t subgroup_size = kernel::default_subgroup_size;
  /// Invocations that the kernel runs at once: 4, 8, 16 or 32, the wide form; 0: the scalar form, one after the other.
  /// Compute shaders only.
  std::uint32_t lanes = 0;
};

}  // namespace tandem::cpu
