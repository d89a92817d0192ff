#include "rhi_vulkan/pipeline_layout.hpp"

#include <bit>

#include "rhi_vulkan/compute_pipeline.hpp"
#include "rhi_vulkan/ray_tracing_pipeline.hpp"

namespace tandem::vulkan {
namespace {

std::vector<vk::raii::DescriptorSetLayout> make_set_layouts(const Context& context,
                                                            const rhi::PipelineInterface& interface) {
  struct Set {
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    std::vector<vk::DescriptorBindingFlags> flags;
  };
  std::vector<Set> sets;
  for (const rhi::ShaderBinding& binding : interface.bindings) {
    if (binding.set >= sets.size()) sets.resize(binding.set + 1);
    Set& set = sets[binding.set];
    set.bindings.push_back({.binding = binding.binding,
                            .descriptorType = descriptor_type(binding.kind),
                            .descriptorCount = capacity(interface, binding),
                            .stageFlags = context.physical.shader_stages});
    const bool may_miss = binding.count != 1 && context.physical.info.capabilities.partially_bound;
    set.flags.push_back(may_miss ? vk::DescriptorBindingFlagBits::ePartiallyBound : vk::DescriptorBindingFlags());
  }
  std::vector<vk::raii::DescriptorSetLayout> layouts;
  for (const Set& set : sets) {
    const vk::DescriptorSetLayoutBindingFlagsCreateInfo flags = {
        .bindingCount = static_cast<std::uint32_t>(set.flags.size()), .pBindingFlags = set.flags.data()};
    layouts.push_back(
        context.device.createDescriptorSetLayout({.pNext = &flags,
                                                  .bindingCount = static_cast<std::uint32_t>(set.bindings.size()),
                                                  .pBindings = set.bindings.data()}));
  }
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

Specialization::Specialization(std::span<const rhi::SpecializationValue> values,
                               std::span<const rhi::ShaderModuleHandle> shaders) {
  const auto width_of = [&](std::uint32_t id) {
    for (const rhi::ShaderModuleHandle& shader : shaders)
      for (const rhi::SpecializationConstant& constant : shader->reflection().specialization_constants)
        if (constant.id == id) return constant.width;
    return 32u;
  };
  // The lowest bytes come first.
  static_assert(std::endian::native == std::endian::little);
  for (std::size_t i = 0; i < values.size(); ++i)
    entries_.push_back({.constantID = values[i].id,
                        .offset = static_cast<std::uint32_t>(i * sizeof(rhi::SpecializationValue) +
                                                             offsetof(rhi::SpecializationValue, value)),
                        .size = width_of(values[i].id) / 8});
  info_ = vk::SpecializationInfo{.mapEntryCount = static_cast<std::uint32_t>(entries_.size()),
                                 .pMapEntries = entries_.data(),
                                 .dataSize = values.size_bytes(),
                                 .pData = values.data()};
}

}  // namespace tandem::vulkan
