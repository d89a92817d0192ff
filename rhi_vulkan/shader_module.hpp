#pragma once

#include <mutex>

#include "rhi/shader_module.hpp"
#include "rhi_vulkan/context.hpp"

namespace tandem::vulkan {

class ShaderModule final : public rhi::ShaderModule {
 public:
  ShaderModule(ContextHandle context, const rhi::ShaderModuleDesc& desc);

  const ContextHandle& context() const noexcept { return context_; }
  /// The driver's object, made when a pipeline asks for it: a module that the device cannot run may still be reflected.
  /// Throws rhi::Error(unsupported) for what the device's features do not allow, ray queries included.
  vk::ShaderModule handle() const;

 private:
  ContextHandle context_;
  mutable std::mutex mutex_;
  mutable vk::raii::ShaderModule module_ = nullptr;
};

}  // namespace tandem::vulkan
