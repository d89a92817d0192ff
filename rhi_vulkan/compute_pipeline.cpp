#include "rhi_vulkan/compute_pipeline.hpp"

#include <utility>

#include "rhi_vulkan/shader_module.hpp"

namespace tandem::vulkan {

ComputePipeline::ComputePipeline(ContextHandle context, const rhi::ComputePipelineDesc& desc)
    : rhi::ComputePipeline(desc), context_(std::move(context)) {
  const auto& shader = own<ShaderModule>(desc.shader, context_, desc.label, "shader module");
  translating_errors(desc.label, "create the compute pipeline", [&] {
    layout_.emplace(*context_, interface());
    const Specialization specialization(desc.specialization, {&desc.shader, 1});
    const vk::PipelineShaderStageRequiredSubgroupSizeCreateInfo subgroup_size = {.requiredSubgroupSize =
                                                                                     desc.required_subgroup_size};
    vk::PipelineShaderStageCreateFlags flags;
    if (desc.full_subgroups) flags |= vk::PipelineShaderStageCreateFlagBits::eRequireFullSubgroups;
    const vk::PipelineShaderStageCreateInfo stage = {
        .pNext = desc.required_subgroup_size != 0 ? &subgroup_size : nullptr,
        .flags = flags,
        .stage = vk::ShaderStageFlagBits::eCompute,
        .module = shader.handle(),
        .pName = reflection().entry_point.c_str(),
        .pSpecializationInfo = &specialization.info()};
    pipeline_ = context_->device.createComputePipeline(
        nullptr, {.flags = vk::PipelineCreateFlagBits::eDispatchBase, .stage = stage, .layout = layout_->handle()});
    context_->name(pipeline_, desc.label);
  });
}

}  // namespace tandem::vulkan
