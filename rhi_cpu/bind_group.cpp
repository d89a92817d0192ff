#include "rhi_cpu/bind_group.hpp"

#include <algorithm>
#include <utility>

#include "rhi/texture_view.hpp"
#include "rhi/validation/built.hpp"
#include "rhi_cpu/acceleration_structure.hpp"
#include "rhi_cpu/buffer.hpp"
#include "rhi_cpu/sampler.hpp"
#include "rhi_cpu/texture.hpp"

namespace tandem::cpu {
namespace {

/// A Resource has one type for all: kernels only read what is no buffer.
template <typename View>
kernel::Resource resource_of(const View* view) {
  return {.data = reinterpret_cast<std::byte*>(const_cast<View*>(view)), .size = 0};
}

/// Levels and layers of a texture as an image of its own.
kernel::Image image_of(const Texture& texture, const rhi::ResolvedView& view) {
  const bool is_line = rhi::side_count(view.dimension) == 1;
  kernel::Image image = texture.image();
  const rhi::TextureDesc& desc = texture.desc();
  for (std::uint32_t i = 0; i < view.level_count; ++i) {
    const std::uint32_t level = view.first_level + i;
    const std::uint64_t layers = rhi::is_layered(desc.dimension) ? desc.size[2] : 1;
    image.level_offsets[i] =
        rhi::level_offset(desc, level) + rhi::level_size_in_bytes(desc, level) / layers * view.first_layer;
  }
  image.texels += std::exchange(image.level_offsets[0], 0);
  for (std::uint32_t i = 1; i < view.level_count; ++i)
    image.level_offsets[i] -= static_cast<std::uint64_t>(image.texels - texture.image().texels);
  const std::array<std::uint32_t, 3> size = rhi::level_size(desc, view.first_level);
  std::copy(size.begin(), size.end(), image.size);
  if (rhi::is_layered(desc.dimension)) image.size[2] = view.layer_count;
  if (is_line) std::swap(image.size[1], image.size[2]);
  image.level_count = view.level_count;
  return image;
}

kernel::Image image_of(const Buffer& buffer, const rhi::TexelBuffer& texels) {
  return {.texels = buffer.data() + texels.range.offset,
          .size = {static_cast<std::uint32_t>(texels.range.resolved_size() / rhi::size_of(texels.format)), 1, 1},
          .format = static_cast<std::uint32_t>(texels.format),
          .sides = 1};
}

bool is_storage_image(const rhi::BindGroupDesc& desc, std::uint32_t binding) {
  const std::vector<rhi::ShaderBinding>& bindings = desc.pipeline->interface().bindings;
  return std::any_of(bindings.begin(), bindings.end(), [&](const rhi::ShaderBinding& each) {
    return each.set == desc.set && each.binding == binding && each.kind == rhi::BindingKind::storage_image;
  });
}

kernel::Resource current(const BindGroup::Bound& bound, const std::string& label) {
  if (bound.structure == nullptr) return bound.resource;
  rhi::validation::check_traced(*bound.structure, bound.structure->view() != nullptr, label);
  return resource_of(bound.structure->view());
}

/// The elements of a binding, of which the table has room for `count`; beyond that, and with 0, it grows.
void put(const BindGroup& group, std::uint32_t binding, std::vector<kernel::Resource>& table, std::size_t first,
         std::size_t count, const std::string& label) {
  for (const BindGroup::Bound& bound : group.bound()) {
    if (bound.binding != binding) continue;
    if (count == 0 && bound.element >= table.size()) table.resize(bound.element + 1);
    if (count == 0 || bound.element < count) table[first + bound.element] = current(bound, label);
  }
}

}  // namespace

BindGroup::BindGroup(DeviceStateHandle device, const rhi::BindGroupDesc& desc)
    : rhi::BindGroup(desc), device_(std::move(device)) {
  for (const rhi::BindGroupEntry& entry : desc.entries) bound_.push_back(bind(entry));
}

BindGroup::Bound BindGroup::bind(const rhi::BindGroupEntry& entry) {
  Bound bound = {.binding = entry.binding, .element = entry.array_element, .resource = {}, .structure = {}};
  const rhi::BufferRange range = rhi::range_of(entry.resource);
  const rhi::TextureView view = rhi::view_of(entry.resource);
  const rhi::SamplerHandle sampler_handle = rhi::sampler_of(entry.resource);
  const kernel::Sampler* sampler =
      sampler_handle == nullptr ? nullptr : &own<Sampler>(sampler_handle, *device_, label())->view();
  if (const auto* texels = std::get_if<rhi::TexelBuffer>(&entry.resource)) {
    bound.resource =
        resource_of(&images_.emplace_back(image_of(*own<Buffer>(range.buffer, *device_, label()), *texels)));
  } else if (!range.empty()) {
    const auto buffer = own<Buffer>(range.buffer, *device_, label());
    bound.resource = {.data = buffer->data() + range.offset, .size = range.resolved_size()};
  } else if (view.texture != nullptr) {
    const auto texture = own<Texture>(view.texture, *device_, label());
    const rhi::ResolvedView whole = rhi::resolved(view, is_storage_image(desc(), entry.binding));
    const kernel::Image& image = images_.emplace_back(image_of(*texture, whole));
    bound.resource = sampler == nullptr
                         ? resource_of(&image)
                         : resource_of(&sampled_images_.emplace_back(kernel::SampledImage{&image, sampler}));
  } else if (sampler != nullptr) {
    bound.resource = resource_of(sampler);
  } else if (const auto& structure = std::get<rhi::AccelerationStructureHandle>(entry.resource); structure != nullptr) {
    bound.structure = own<TopLevelStructure>(structure, *device_, label());
  }
  return bound;
}

ResourceTable resource_table(const kernel::KernelInfo& kernel, std::span<const std::shared_ptr<BindGroup>> groups,
                             const std::string& label) {
  ResourceTable table;
  table.resources.resize(kernel.resource_count);
  for (const kernel::BindingSlot& slot : std::span(kernel.bindings, kernel.binding_count)) {
    std::vector<kernel::Resource> unsized;
    const bool is_unsized = slot.count == 0;
    for (const std::shared_ptr<BindGroup>& group : groups) {
      if (group->desc().set != slot.set) continue;
      if (is_unsized)
        put(*group, slot.binding, unsized, 0, 0, label);
      else
        put(*group, slot.binding, table.resources, slot.first_resource, slot.count, label);
    }
    if (!is_unsized) continue;
    // Moving the vector of vectors keeps the elements where they are.
    std::vector<kernel::Resource>& kept = table.unsized_arrays.emplace_back(std::move(unsized));
    table.resources[slot.first_resource] = {.data = reinterpret_cast<std::byte*>(kept.data()), .size = kept.size()};
  }
  return table;
}

}  // namespace tandem::cpu
