#include "rhi_vulkan/compute_pipeline.hpp"

#include <utility>

#include "rhi_vulkan/shader_module.hpp"

namespace tandem::vulkan {
namespace {

std::vector<vk::raii::DescriptorSetLayout> make_set_layouts(const vk::raii::Device& device,
                                                            const rhi::ShaderReflection& reflection) {
  std::vector<std::vector<vk::DescriptorSetLayoutBinding>> sets;
  for (const rhi::ShaderBinding& binding : reflection.bindings) {
    if (binding.set >= sets.size()) sets.resize(binding.set + 1);
    sets[binding.set].push_back({.binding = binding.binding,
                                 .descriptorType = descriptor_type(binding.kind),
                                 .descriptorCount = binding.count,
                                 .stageFlags = vk::ShaderStageFlagBits::eCompute});
  }
  std::vector<vk::raii::DescriptorSetLayout> layouts;
  for (const std::vector<vk::DescriptorSetLayoutBinding>& bindings : sets)
    layouts.push_back(device.createDescriptorSetLayout(
        {.bindingCount = static_cast<std::uint32_t>(bindings.size()), .pBindings = bindings.data()}));
  return layouts;
}

vk::raii::PipelineLayout make_layout(const vk::raii::Device& device,
                                     const std::vector<vk::raii::DescriptorSetLayout>& set_layouts,
                                     std::uint32_t push_constant_size) {
  std::vector<vk::DescriptorSetLayout> handles;
  for (const vk::raii::DescriptorSetLayout& layout : set_layouts) handles.push_back(*layout);
  const vk::PushConstantRange push_constants = {.stageFlags = vk::ShaderStageFlagBits::eCompute,
                                                .size = push_constant_size};
  return device.createPipelineLayout({.setLayoutCount = static_cast<std::uint32_t>(handles.size()),
                                      .pSetLayouts = handles.data(),
                                      .pushConstantRangeCount = push_constant_size > 0 ? 1u : 0u,
                                      .pPushConstantRanges = &push_constants});
}

vk::raii::Pipeline make_pipeline(const vk::raii::Device& device, vk::PipelineLayout layout, vk::ShaderModule module,
                                 const rhi::ComputePipelineDesc& desc) {
  std::vector<vk::SpecializationMapEntry> entries;
  for (std::size_t i = 0; i < desc.specialization.size(); ++i)
    entries.push_back({.constantID = desc.specialization[i].id,
                       .offset = static_cast<std::uint32_t>(i * sizeof(rhi::SpecializationValue) +
                                                            offsetof(rhi::SpecializationValue, value)),
                       .size = sizeof(rhi::SpecializationValue::value)});
  const vk::SpecializationInfo specialization = {
      .mapEntryCount = static_cast<std::uint32_t>(entries.size()),
      .pMapEntries = entries.data(),
      .dataSize = desc.specialization.size() * sizeof(rhi::SpecializationValue),
      .pData = desc.specialization.data()};
  const vk::PipelineShaderStageCreateInfo stage = {.stage = vk::ShaderStageFlagBits::eCompute,
                                                   .module = module,
                                                   .pName = desc.shader->reflection().entry_point.c_str(),
                                                   .pSpecializationInfo = &specialization};
  return device.createComputePipeline(nullptr, {.stage = stage, .layout = layout});
}

}  // namespace

vk::DescriptorType descriptor_type(rhi::BindingKind kind) {
  switch (kind) {
    case rhi::BindingKind::uniform_buffer:
      return vk::DescriptorType::eUniformBuffer;
    case rhi::BindingKind::storage_buffer:
      return vk::DescriptorType::eStorageBuffer;
    case rhi::BindingKind::acceleration_structure:
      return vk::DescriptorType::eAccelerationStructureKHR;
    default:
      throw rhi::Error(rhi::ErrorCode::unsupported, "", "bind groups hold no images and no samplers");
  }
}

ComputePipeline::ComputePipeline(ContextHandle context, const rhi::ComputePipelineDesc& desc)
    : rhi::ComputePipeline(desc), context_(std::move(context)) {
  const auto& shader = own<ShaderModule>(desc.shader, context_, desc.label, "shader module");
  translating_errors(desc.label, "create the compute pipeline", [&] {
    set_layouts_ = make_set_layouts(context_->device, reflection());
    layout_ = make_layout(context_->device, set_layouts_, reflection().push_constant_size);
    pipeline_ = make_pipeline(context_->device, *layout_, shader.handle(), desc);
    context_->name(pipeline_, desc.label);
  });
}

}  // namespace tandem::vulkan
