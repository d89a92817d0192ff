#include "rhi_cpu/bind_group.hpp"

#include "rhi/validation/built.hpp"
#include "rhi_cpu/acceleration_structure.hpp"
#include "rhi_cpu/buffer.hpp"
#include "rhi_cpu/texture.hpp"

namespace tandem::cpu {
namespace {

kernel::Resource resource_of(const rhi::BoundResource& bound, const std::string& label) {
  if (const auto* range = std::get_if<rhi::BufferRange>(&bound)) {
    const auto& buffer = static_cast<const Buffer&>(*range->buffer);
    return {.data = buffer.data() + range->offset, .size = range->resolved_size()};
  }
  // A Resource has one type for all: the kernel only reads an image's description and a top level.
  if (const auto* texture = std::get_if<rhi::TextureHandle>(&bound)) {
    const kernel::Image& image = static_cast<const Texture&>(**texture).image();
    return {.data = reinterpret_cast<std::byte*>(const_cast<kernel::Image*>(&image)), .size = 0};
  }
  const auto& handle = std::get<rhi::AccelerationStructureHandle>(bound);
  if (handle == nullptr) return {};
  const auto& structure = static_cast<const TopLevelStructure&>(*handle);
  rhi::validation::check_traced(structure, structure.view() != nullptr, label);
  return {.data = reinterpret_cast<std::byte*>(const_cast<kernel::TopLevel*>(structure.view())), .size = 0};
}

void check_owner(const rhi::BoundResource& bound, const DeviceState& device, const std::string& label) {
  if (const auto* range = std::get_if<rhi::BufferRange>(&bound))
    own<Buffer>(range->buffer, device, label);
  else if (const auto* texture = std::get_if<rhi::TextureHandle>(&bound))
    own<Texture>(*texture, device, label);
  else if (const auto& structure = std::get<rhi::AccelerationStructureHandle>(bound); structure != nullptr)
    own<TopLevelStructure>(structure, device, label);
}

}  // namespace

BindGroup::BindGroup(DeviceStateHandle device, const rhi::BindGroupDesc& desc)
    : rhi::BindGroup(desc), device_(std::move(device)) {
  for (const rhi::BindGroupEntry& entry : desc.entries) check_owner(entry.resource, *device_, desc.label);
}

std::vector<kernel::Resource> resource_table(const kernel::KernelInfo& kernel,
                                             std::span<const std::shared_ptr<BindGroup>> groups,
                                             const std::string& label) {
  std::vector<kernel::Resource> table(kernel.resource_count);
  for (const kernel::BindingSlot& slot : std::span(kernel.bindings, kernel.binding_count)) {
    for (const std::shared_ptr<BindGroup>& group : groups) {
      if (group->desc().set != slot.set) continue;
      for (const rhi::BindGroupEntry& entry : group->desc().entries)
        if (entry.binding == slot.binding && entry.array_element < slot.count)
          table[slot.first_resource + entry.array_element] = resource_of(entry.resource, label);
    }
  }
  return table;
}

}  // namespace tandem::cpu
