#include <algorithm>
#include <string>
#include <string_view>

#include "rhi/validation.hpp"
#include "rhi/validation/require.hpp"

namespace tandem::rhi::validation {
namespace {

using std::to_string;

const ShaderBinding* find_binding(const PipelineInterface& interface, std::uint32_t set, std::uint32_t binding) {
  const auto found = std::find_if(interface.bindings.begin(), interface.bindings.end(),
                                  [&](const ShaderBinding& b) { return b.set == set && b.binding == binding; });
  return found == interface.bindings.end() ? nullptr : &*found;
}

void check_bound_buffer(const BufferRange& range, BindingKind kind, std::string_view label, const std::string& what,
                        const Limits& limits) {
  const bool is_uniform = kind == BindingKind::uniform_buffer;
  require(is_uniform || kind == BindingKind::storage_buffer, label, what + " is not a buffer in the shader");
  require_range(label, range, what);
  require(has(range.buffer->desc().usage, is_uniform ? BufferUsage::uniform : BufferUsage::storage), label,
          what + ": " + name_of(range.buffer) + " lacks the usage " + (is_uniform ? "uniform" : "storage"));
  const std::uint64_t alignment =
      is_uniform ? limits.uniform_buffer_offset_alignment : limits.storage_buffer_offset_alignment;
  require(range.offset % alignment == 0, label,
          what + " begins at byte " + to_string(range.offset) + ", which is no multiple of the device's " +
              to_string(alignment));
  const std::uint64_t limit = is_uniform ? limits.max_uniform_buffer_range : limits.max_storage_buffer_range;
  require(range.resolved_size() <= limit, label,
          what + " has " + to_string(range.resolved_size()) + " bytes, more than the device's " + to_string(limit));
}

void check_bound_structure(const AccelerationStructureHandle& structure, const ShaderBinding& binding,
                           std::string_view label, const std::string& what, const DeviceInfo& device) {
  require(binding.kind == BindingKind::acceleration_structure, label,
          what + " is not an acceleration structure in the shader");
  if (structure == nullptr) {
    if (!device.capabilities.null_acceleration_structure)
      throw Error(ErrorCode::unsupported, label,
                  what + " names no acceleration structure, which device '" + device.name + "' does not support");
    return;
  }
  require(structure->level() == AccelerationStructure::Level::top, label,
          what + ": '" + structure->label() + "' is a bottom level, where a shader needs a top level");
}

void check_bound_texture(const TextureHandle& texture, const ShaderBinding& binding, std::string_view label,
                         const std::string& what) {
  require(binding.kind == BindingKind::storage_image, label, what + " is not a storage image in the shader");
  require(texture != nullptr, label, what + " names no texture");
  const TextureDesc& desc = texture->desc();
  require(desc.dimension == binding.dimension, label,
          what + ": texture '" + desc.label + "' has another dimension than the image in the shader");
  require(!binding.format || *binding.format == desc.format, label,
          what + ": texture '" + desc.label + "' has another format than the image in the shader");
}

void check_resource(const BoundResource& resource, const ShaderBinding& binding, std::string_view label,
                    const std::string& what, const DeviceInfo& device) {
  if (const auto* range = std::get_if<BufferRange>(&resource))
    check_bound_buffer(*range, binding.kind, label, what, device.limits);
  else if (const auto* texture = std::get_if<TextureHandle>(&resource))
    check_bound_texture(*texture, binding, label, what);
  else
    check_bound_structure(std::get<AccelerationStructureHandle>(resource), binding, label, what, device);
}

}  // namespace

void check(const BindGroupDesc& desc, const DeviceInfo& device) {
  require(desc.pipeline != nullptr, desc.label, "a bind group needs a pipeline");
  const PipelineInterface& interface = desc.pipeline->interface();
  std::uint64_t wanted = 0;
  for (const ShaderBinding& binding : interface.bindings)
    if (binding.set == desc.set) wanted += binding.count;
  require(wanted > 0, desc.label,
          "the pipeline '" + desc.pipeline->label() + "' uses nothing of set " + to_string(desc.set));

  for (std::size_t i = 0; i < desc.entries.size(); ++i) {
    const BindGroupEntry& entry = desc.entries[i];
    const ShaderBinding* binding = find_binding(interface, desc.set, entry.binding);
    const std::string place = "set " + to_string(desc.set) + " binding " + to_string(entry.binding);
    require(binding != nullptr, desc.label, "the pipeline '" + desc.pipeline->label() + "' has no " + place);
    const std::string what = place + " ('" + binding->name + "')";
    require(entry.array_element < binding->count, desc.label,
            what + " has " + to_string(binding->count) + " elements, so there is no element " +
                to_string(entry.array_element));
    for (std::size_t j = 0; j < i; ++j)
      require(desc.entries[j].binding != entry.binding || desc.entries[j].array_element != entry.array_element,
              desc.label, what + " element " + to_string(entry.array_element) + " is given twice");
    check_resource(entry.resource, *binding, desc.label, what, device);
  }
  require(desc.entries.size() == wanted, desc.label,
          "set " + to_string(desc.set) + " of pipeline '" + desc.pipeline->label() + "' needs " + to_string(wanted) +
              " entries, but " + to_string(desc.entries.size()) + " are given");
}

}  // namespace tandem::rhi::validation
