#include "rhi_vulkan/bind_group.hpp"

#include <utility>
#include <vector>

#include "rhi_vulkan/acceleration_structure.hpp"
#include "rhi_vulkan/buffer.hpp"
#include "rhi_vulkan/pipeline_layout.hpp"
#include "rhi_vulkan/texture.hpp"

namespace tandem::vulkan {
namespace {

DescriptorCounts count_descriptors(const rhi::PipelineInterface& interface, std::uint32_t set) {
  DescriptorCounts counts;
  for (const rhi::ShaderBinding& binding : interface.bindings) {
    if (binding.set != set) continue;
    if (binding.kind == rhi::BindingKind::uniform_buffer) counts.uniform_buffers += binding.count;
    if (binding.kind == rhi::BindingKind::storage_buffer) counts.storage_buffers += binding.count;
    if (binding.kind == rhi::BindingKind::acceleration_structure) counts.acceleration_structures += binding.count;
    if (binding.kind == rhi::BindingKind::storage_image) counts.storage_images += binding.count;
  }
  return counts;
}

rhi::BindingKind kind_of(const rhi::PipelineInterface& interface, std::uint32_t set, std::uint32_t binding) {
  for (const rhi::ShaderBinding& candidate : interface.bindings)
    if (candidate.set == set && candidate.binding == binding) return candidate.kind;
  throw rhi::Error(rhi::ErrorCode::invalid_argument, "", "no binding " + std::to_string(binding));
}

}  // namespace

BindGroup::BindGroup(ContextHandle context, const rhi::BindGroupDesc& desc)
    : rhi::BindGroup(desc), context_(std::move(context)) {
  const PipelineLayout& layout = layout_of(desc.pipeline, context_, desc.label);
  translating_errors(desc.label, "create the bind group", [&] {
    set_.emplace(context_->descriptors, layout.set_layout(desc.set),
                 count_descriptors(desc.pipeline->interface(), desc.set));
    context_->name(set_->handle(), desc.label);
  });
  write();
}

void BindGroup::write() const {
  const std::vector<rhi::BindGroupEntry>& entries = desc().entries;
  // Filled to their final size first: the writes point into them.
  std::vector<vk::DescriptorBufferInfo> buffers(entries.size());
  std::vector<vk::DescriptorImageInfo> images(entries.size());
  std::vector<vk::AccelerationStructureKHR> structures(entries.size());
  std::vector<vk::WriteDescriptorSetAccelerationStructureKHR> structure_writes(entries.size());
  std::vector<vk::WriteDescriptorSet> writes;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const rhi::BindGroupEntry& entry = entries[i];
    vk::WriteDescriptorSet write = {
        .dstSet = *set_->handle(),
        .dstBinding = entry.binding,
        .dstArrayElement = entry.array_element,
        .descriptorCount = 1,
        .descriptorType = descriptor_type(kind_of(desc().pipeline->interface(), desc().set, entry.binding))};
    if (const auto* range = std::get_if<rhi::BufferRange>(&entry.resource)) {
      buffers[i] = vk::DescriptorBufferInfo{.buffer = own<Buffer>(range->buffer, context_, label(), "buffer").handle(),
                                            .offset = range->offset,
                                            .range = range->resolved_size()};
      write.pBufferInfo = &buffers[i];
    } else if (const auto* texture = std::get_if<rhi::TextureHandle>(&entry.resource)) {
      images[i] = vk::DescriptorImageInfo{.imageView = own<Texture>(*texture, context_, label(), "texture").view(),
                                          .imageLayout = vk::ImageLayout::eGeneral};
      write.pImageInfo = &images[i];
    } else {
      const auto& structure = std::get<rhi::AccelerationStructureHandle>(entry.resource);
      if (structure != nullptr)
        structures[i] = own<AccelerationStructure>(structure, context_, label(), "acceleration structure").handle();
      structure_writes[i] = vk::WriteDescriptorSetAccelerationStructureKHR{.accelerationStructureCount = 1,
                                                                           .pAccelerationStructures = &structures[i]};
      write.pNext = &structure_writes[i];
    }
    writes.push_back(write);
  }
  context_->device.updateDescriptorSets(writes, nullptr);
}

}  // namespace tandem::vulkan
