#include "rhi_vulkan/shader_module.hpp"

#include <utility>

#include "rhi_vulkan/shader_capabilities.hpp"

namespace tandem::vulkan {

ShaderModule::ShaderModule(ContextHandle context, const rhi::ShaderModuleDesc& desc)
    : rhi::ShaderModule(desc), context_(std::move(context)) {
  check_shader_capabilities(spirv(), context_->physical, desc.label);
  translating_errors(desc.label, "create the shader module", [&] {
    module_ = context_->device.createShaderModule({.codeSize = spirv().size_bytes(), .pCode = spirv().data()});
    context_->name(module_, desc.label);
  });
}

}  // namespace tandem::vulkan
