#pragma once

#include "rhi/shader_module.hpp"
#include "rhi_vulkan/context.hpp"

namespace tandem::vulkan {

class ShaderModule final : public rhi::ShaderModule {
 public:
  /// Throws rhi::Error(unsupported) for what the device's features do not allow, ray queries included.
  ShaderModule(ContextHandle context, const rhi::ShaderModuleDesc& desc);

  const ContextHandle& context() const noexcept { return context_; }
  vk::ShaderModule handle() const { return *module_; }

 private:
  ContextHandle context_;
  vk::raii::ShaderModule module_ = nullptr;
};

}  // namespace tandem::vulkan
