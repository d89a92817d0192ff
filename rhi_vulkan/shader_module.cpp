#include "rhi_vulkan/shader_module.hpp"

#include <utility>

#include "rhi_vulkan/shader_capabilities.hpp"

namespace tandem::vulkan {

ShaderModule::ShaderModule(ContextHandle context, const rhi::ShaderModuleDesc& desc)
    : rhi::ShaderModule(desc), context_(std::move(context)) {}

vk::ShaderModule ShaderModule::handle() const {
  const std::scoped_lock lock(mutex_);
  if (*module_) return *module_;
  check_shader_capabilities(spirv(), context_->physical, label());
  translating_errors(label(), "create the shader module", [&] {
    module_ = context_->device.createShaderModule({.codeSize = spirv().size_bytes(), .pCode = spirv().data()});
    context_->name(module_, label());
  });
  return *module_;
}

}  // namespace tandem::vulkan
