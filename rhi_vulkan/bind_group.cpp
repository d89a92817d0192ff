#include "rhi_vulkan/bind_group.hpp"

#include <utility>
#include <vector>

#include "rhi_vulkan/acceleration_structure.hpp"
#include "rhi_vulkan/buffer.hpp"
#include "rhi_vulkan/formats.hpp"
#include "rhi_vulkan/pipeline_layout.hpp"
#include "rhi_vulkan/sampler.hpp"
#include "rhi_vulkan/texture.hpp"

namespace tandem::vulkan {
namespace {

DescriptorCounts count_descriptors(const rhi::PipelineInterface& interface, std::uint32_t set) {
  DescriptorCounts counts = {};
  for (const rhi::ShaderBinding& binding : interface.bindings)
    if (binding.set == set) counts[static_cast<std::size_t>(binding.kind)] += capacity(interface, binding);
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
    write();
  });
}

vk::ImageView BindGroup::make_view(const rhi::ResolvedView& view) {
  const auto& texture = own<Texture>(view.texture, context_, label(), "texture");
  image_views_.push_back(
      context_->device.createImageView({.image = texture.handle(),
                                        .viewType = view_type_of(view.dimension),
                                        .format = format_of(texture.desc().format),
                                        .subresourceRange = {.aspectMask = aspect_of(texture.desc().format),
                                                             .baseMipLevel = view.first_level,
                                                             .levelCount = view.level_count,
                                                             .baseArrayLayer = view.first_layer,
                                                             .layerCount = view.layer_count}}));
  context_->name(image_views_.back(), texture.desc().label);
  return *image_views_.back();
}

vk::BufferView BindGroup::make_view(const rhi::TexelBuffer& texels) {
  const auto& buffer = own<Buffer>(texels.range.buffer, context_, label(), "buffer");
  buffer_views_.push_back(context_->device.createBufferView({.buffer = buffer.handle(),
                                                             .format = format_of(texels.format),
                                                             .offset = texels.range.offset,
                                                             .range = texels.range.resolved_size()}));
  return *buffer_views_.back();
}

vk::DescriptorImageInfo BindGroup::image_info(const rhi::BoundResource& resource, rhi::BindingKind kind) {
  vk::DescriptorImageInfo info = {.imageLayout = vk::ImageLayout::eGeneral};
  if (const rhi::SamplerHandle sampler = rhi::sampler_of(resource); sampler != nullptr)
    info.sampler = own<Sampler>(sampler, context_, label(), "sampler").handle();
  if (const rhi::TextureView view = rhi::view_of(resource); view.texture != nullptr)
    info.imageView = make_view(rhi::resolved(view, kind == rhi::BindingKind::storage_image));
  return info;
}

void BindGroup::write() {
  const std::vector<rhi::BindGroupEntry>& entries = desc().entries;
  // Filled to their final size first: the writes point into them.
  std::vector<vk::DescriptorBufferInfo> buffers(entries.size());
  std::vector<vk::DescriptorImageInfo> images(entries.size());
  std::vector<vk::BufferView> texels(entries.size());
  std::vector<vk::AccelerationStructureKHR> structures(entries.size());
  std::vector<vk::WriteDescriptorSetAccelerationStructureKHR> structure_writes(entries.size());
  std::vector<vk::WriteDescriptorSet> writes;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const rhi::BindGroupEntry& entry = entries[i];
    const rhi::BindingKind kind = kind_of(desc().pipeline->interface(), desc().set, entry.binding);
    vk::WriteDescriptorSet write = {.dstSet = *set_->handle(),
                                    .dstBinding = entry.binding,
                                    .dstArrayElement = entry.array_element,
                                    .descriptorCount = 1,
                                    .descriptorType = descriptor_type(kind)};
    if (const auto* range = std::get_if<rhi::BufferRange>(&entry.resource)) {
      buffers[i] = vk::DescriptorBufferInfo{.buffer = own<Buffer>(range->buffer, context_, label(), "buffer").handle(),
                                            .offset = range->offset,
                                            .range = range->resolved_size()};
      write.pBufferInfo = &buffers[i];
    } else if (const auto* texel_buffer = std::get_if<rhi::TexelBuffer>(&entry.resource)) {
      texels[i] = make_view(*texel_buffer);
      write.pTexelBufferView = &texels[i];
    } else if (const auto* structure = std::get_if<rhi::AccelerationStructureHandle>(&entry.resource)) {
      if (*structure != nullptr)
        structures[i] = own<AccelerationStructure>(*structure, context_, label(), "acceleration structure").handle();
      structure_writes[i] = vk::WriteDescriptorSetAccelerationStructureKHR{.accelerationStructureCount = 1,
                                                                           .pAccelerationStructures = &structures[i]};
      write.pNext = &structure_writes[i];
    } else {
      images[i] = image_info(entry.resource, kind);
      write.pImageInfo = &images[i];
    }
    writes.push_back(write);
  }
  context_->device.updateDescriptorSets(writes, nullptr);
}

}  // namespace tandem::vulkan
