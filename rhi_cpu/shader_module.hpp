#pragma once

#include "rhi/shader_module.hpp"

namespace tandem::cpu {

/// SPIR-V as it was given; it is translated when a pipeline is made of it.
class ShaderModule final : public rhi::ShaderModule {
 public:
  explicit ShaderModule(const rhi::ShaderModuleDesc& desc) : rhi::ShaderModule(desc) {}
};

}  // namespace tandem::cpu
