#include "rhi_vulkan/pipeline_layout.hpp"

#include "rhi_vulkan/compute_pipeline.hpp"
#include "rhi_vulkan/ray_tracing_pipeline.hpp"

namespace tandem::vulkan {
namespace {

std::vector<vk::raii::DescriptorSetLayout> make_set_layouts(const Context& context,
                                                            const rhi::PipelineInterface& interface) {
  std::vector<std::vector<vk::DescriptorSetLayoutBinding>> sets;
  for (const rhi::ShaderBinding& binding : interface.bindings) {
    if (binding.set >= sets.size()) sets.resize(binding.set + 1);
    sets[binding.set].push_back({.binding = binding.binding,
                                 .descriptorType = descriptor_type(binding.kind),
                                 .descriptorCount = binding.count,
                                 .stageFlags = context.physical.shader_stages});
  }
  std::vector<vk::raii::DescriptorSetLayout> layouts;
  for (const std::vector<vk::DescriptorSetLayoutBinding>& bindings : sets)
    layouts.push_back(context.device.createDescriptorSetLayout(
        {.bindingCount = static_cast<std::uint32_t>(bindings.size()), .pBindings = bindings.data()}));
  return layouts;
}

}  // namespace

PipelineLayout::PipelineLayout(const Context& context, const rhi::PipelineInterface& interface)
    : set_layouts_(make_set_layouts(context, interface)) {
  std::vector<vk::DescriptorSetLayout> handles;
  for (const vk::raii::DescriptorSetLayout& layout : set_layouts_) handles.push_back(*layout);
  const vk::PushConstantRange push_constants = {.stageFlags = context.physical.shader_stages,
                                                .size = interface.push_constant_size};
  layout_ = context.device.createPipelineLayout({.setLayoutCount = static_cast<std::uint32_t>(handles.size()),
                                                 .pSetLayouts = handles.data(),
                                                 .pushConstantRangeCount = interface.push_constant_size > 0 ? 1u : 0u,
                                                 .pPushConstantRanges = &push_constants});
}

const PipelineLayout& layout_of(const rhi::PipelineHandle& pipeline, const ContextHandle& context,
                                const std::string& label) {
  if (pipeline->kind() == rhi::Pipeline::Kind::compute)
    return own<ComputePipeline>(pipeline, context, label, "pipeline").layout();
  return own<RayTracingPipeline>(pipeline, context, label, "pipeline").layout();
}

vk::DescriptorType descriptor_type(rhi::BindingKind kind) {
  switch (kind) {
    case rhi::BindingKind::uniform_buffer:
      return vk::DescriptorType::eUniformBuffer;
    case rhi::BindingKind::storage_buffer:
      return vk::DescriptorType::eStorageBuffer;
    case rhi::BindingKind::acceleration_structure:
      return vk::DescriptorType::eAccelerationStructureKHR;
    case rhi::BindingKind::storage_image:
      return vk::DescriptorType::eStorageImage;
    default:
      throw rhi::Error(rhi::ErrorCode::unsupported, "", "bind groups hold no sampled images and no samplers");
  }
}

Specialization::Specialization(std::span<const rhi::SpecializationValue> values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    entries_.push_back({.constantID = values[i].id,
                        .offset = static_cast<std::uint32_t>(i * sizeof(rhi::SpecializationValue) +
                                                             offsetof(rhi::SpecializationValue, value)),
                        .size = sizeof(rhi::SpecializationValue::value)});
  info_ = vk::SpecializationInfo{.mapEntryCount = static_cast<std::uint32_t>(entries_.size()),
                                 .pMapEntries = entries_.data(),
                                 .dataSize = values.size_bytes(),
                                 .pData = values.data()};
}

}  // namespace tandem::vulkan
