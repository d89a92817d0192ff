#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "rhi/texture_view.hpp"
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
  require_usage(label, range, is_uniform ? BufferUsage::uniform : BufferUsage::storage,
                is_uniform ? "uniform" : "storage", what);
  const std::uint64_t alignment =
      is_uniform ? limits.uniform_buffer_offset_alignment : limits.storage_buffer_offset_alignment;
  require(range.offset % alignment == 0, label,
          what + " begins at byte " + to_string(range.offset) + ", which is no multiple of the device's " +
              to_string(alignment));
  const std::uint64_t limit = is_uniform ? limits.max_uniform_buffer_range : limits.max_storage_buffer_range;
  require(range.resolved_size() <= limit, label,
          what + " has " + to_string(range.resolved_size()) + " bytes, more than the device's " + to_string(limit));
}

/// The kind of the format's components is the one that the shader reads.
void check_components(TextureFormat format, const ShaderBinding& binding, std::string_view label,
                      const std::string& what) {
  const auto read_as = [](ComponentKind kind) {
    const bool is_integer = kind == ComponentKind::uint || kind == ComponentKind::sint;
    return is_integer ? kind : ComponentKind::floating;
  };
  const char* const wanted = binding.component == ComponentKind::uint   ? "unsigned integers"
                             : binding.component == ComponentKind::sint ? "signed integers"
                                                                        : "floats";
  require(read_as(info_of(format).kind) == binding.component, label,
          what + " has the format " + std::string(info_of(format).name) + ", where the shader reads " + wanted);
}

void check_texel_buffer(const TexelBuffer& texels, const ShaderBinding& binding, std::string_view label,
                        const std::string& what, const DeviceInfo& device) {
  const bool is_storage = binding.kind == BindingKind::storage_texel_buffer;
  require(is_storage || binding.kind == BindingKind::uniform_texel_buffer, label,
          what + " is not a texel buffer in the shader");
  require_range(label, texels.range, what);
  require_usage(label, texels.range, is_storage ? BufferUsage::storage_texels : BufferUsage::uniform_texels,
                is_storage ? "storage_texels" : "uniform_texels", what);
  require_alignment(label, texels.range, device.limits.texel_buffer_offset_alignment, what);
  const TextureFormatInfo& format = info_of(texels.format);
  require(texels.range.resolved_size() % format.size == 0, label,
          what + " has " + to_string(texels.range.resolved_size()) + " bytes, which are no whole texels of " +
              std::string(format.name));
  require_limit(texels.range.resolved_size() / format.size, device.limits.max_texel_buffer_elements, label,
                "texels of a buffer");
  require(!binding.format || *binding.format == texels.format, label,
          what + ": the format is " + std::string(format.name) + " where the shader has another");
  check_components(texels.format, binding, label, what);
  const FormatSupport& support = device.formats[static_cast<std::size_t>(texels.format)];
  if (!(is_storage ? support.storage_texel_buffer : support.uniform_texel_buffer))
    throw Error(ErrorCode::unsupported, label,
                what + ": device '" + device.name + "' has no texel buffers of the format " + std::string(format.name));
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

/// Whether a texture of one dimension can be seen as another.
bool can_be_seen_as(const TextureDesc& desc, const ResolvedView& view) {
  const std::uint32_t layers = view.layer_count;
  switch (view.dimension) {
    case TextureDimension::d1:
    case TextureDimension::d2:
      return side_count(desc.dimension) == side_count(view.dimension) && layers == 1;
    case TextureDimension::d3:
      return desc.dimension == TextureDimension::d3;
    case TextureDimension::d1_array:
    case TextureDimension::d2_array:
      return side_count(desc.dimension) == side_count(view.dimension);
    case TextureDimension::cube:
      return side_count(desc.dimension) == 2 && desc.size[0] == desc.size[1] && layers == 6;
    case TextureDimension::cube_array:
      return side_count(desc.dimension) == 2 && desc.size[0] == desc.size[1] && layers % 6 == 0;
  }
  return false;
}

void check_bound_texture(const TextureView& view, const ShaderBinding& binding, std::string_view label,
                         const std::string& what, const DeviceInfo& device) {
  const bool is_storage = binding.kind == BindingKind::storage_image;
  require(view.texture != nullptr, label, what + " names no texture");
  const TextureDesc& desc = view.texture->desc();
  const std::string texture = what + ": texture '" + desc.label + "'";
  const std::uint32_t layers = is_layered(desc.dimension) ? desc.size[2] : 1;
  require(view.first_level < desc.level_count && view.level_count <= desc.level_count - view.first_level, label,
          texture + " has " + to_string(desc.level_count) + " levels, fewer than are bound");
  require(view.first_layer < layers && view.layer_count <= layers - view.first_layer, label,
          texture + " has " + to_string(layers) + " layers, fewer than are bound");
  const ResolvedView whole = resolved(view, is_storage);
  require(whole.dimension == binding.dimension, label, texture + " has another dimension than the image in the shader");
  require(can_be_seen_as(desc, whole), label,
          texture + " with " + to_string(whole.layer_count) + (whole.layer_count == 1 ? " layer" : " layers") +
              " cannot be seen as the image in the shader");
  require(!is_storage || whole.level_count == 1, label, texture + ": a storage image is one level");
  require(!binding.format || *binding.format == desc.format, label,
          texture + " has another format than the image in the shader");
  check_components(desc.format, binding, label, texture);
  const FormatSupport& support = device.formats[static_cast<std::size_t>(desc.format)];
  if (!(is_storage ? support.storage : support.sampled))
    throw Error(ErrorCode::unsupported, label,
                texture + ": device '" + device.name + "' has no " + (is_storage ? "storage" : "sampled") +
                    " images of the format " + std::string(info_of(desc.format).name));
}

/// What VkSampler says of the image that it reads.
void check_sampled(const SampledTexture& sampled, const ShaderBinding& binding, std::string_view label,
                   const std::string& what, const DeviceInfo& device) {
  require(sampled.sampler != nullptr, label, what + " names no sampler");
  const SamplerDesc& sampler = sampled.sampler->desc();
  const TextureDesc& desc = sampled.view.texture->desc();
  const bool filters = sampler.magnification == Filter::linear || sampler.minification == Filter::linear ||
                       sampler.mipmap == Filter::linear;
  if (filters && !device.formats[static_cast<std::size_t>(desc.format)].filtered)
    throw Error(ErrorCode::unsupported, label,
                what + ": device '" + device.name + "' filters no images of the format " +
                    std::string(info_of(desc.format).name));
  require(sampler.compare.has_value() == binding.compares, label,
          what + ": the sampler '" + sampler.label + (binding.compares ? "' does not compare" : "' compares") +
              ", where the shader " + (binding.compares ? "wants that" : "does not want it"));
  require(!sampler.compare || info_of(desc.format).kind == ComponentKind::depth, label,
          what + ": a sampler that compares needs a texture of a depth format");
  const ResolvedView view = resolved(sampled.view, false);
  require(
      !sampler.unnormalized_coordinates ||
          ((view.dimension == TextureDimension::d1 || view.dimension == TextureDimension::d2) && view.level_count == 1),
      label, what + ": a sampler with unnormalised coordinates needs one level of a 1D or 2D texture");
}

void check_resource(const BoundResource& resource, const ShaderBinding& binding, std::string_view label,
                    const std::string& what, const DeviceInfo& device) {
  if (const auto* range = std::get_if<BufferRange>(&resource))
    return check_bound_buffer(*range, binding.kind, label, what, device.limits);
  if (const auto* texels = std::get_if<TexelBuffer>(&resource))
    return check_texel_buffer(*texels, binding, label, what, device);
  if (const auto* structure = std::get_if<AccelerationStructureHandle>(&resource))
    return check_bound_structure(*structure, binding, label, what, device);
  if (const auto* sampler = std::get_if<SamplerHandle>(&resource)) {
    require(binding.kind == BindingKind::sampler, label, what + " is not a sampler in the shader");
    return require(*sampler != nullptr, label, what + " names no sampler");
  }
  if (const auto* sampled = std::get_if<SampledTexture>(&resource)) {
    require(binding.kind == BindingKind::combined_image_sampler, label,
            what + " is not an image with its sampler in the shader");
    check_bound_texture(sampled->view, binding, label, what, device);
    return check_sampled(*sampled, binding, label, what, device);
  }
  require(binding.kind == BindingKind::storage_image || binding.kind == BindingKind::sampled_image, label,
          what + " is not a storage image in the shader, nor an image without a sampler");
  check_bound_texture(view_of(resource), binding, label, what, device);
}

}  // namespace

void check(const BindGroupDesc& desc, const DeviceInfo& device) {
  require(desc.pipeline != nullptr, desc.label, "a bind group needs a pipeline");
  const PipelineInterface& interface = desc.pipeline->interface();
  std::map<std::uint32_t, std::set<std::uint32_t>> given;  // elements of each binding
  for (const ShaderBinding& binding : interface.bindings)
    if (binding.set == desc.set) given[binding.binding];
  require(!given.empty(), desc.label,
          "the pipeline '" + desc.pipeline->label() + "' uses nothing of set " + to_string(desc.set));

  for (const BindGroupEntry& entry : desc.entries) {
    const ShaderBinding* binding = find_binding(interface, desc.set, entry.binding);
    const std::string place = "set " + to_string(desc.set) + " binding " + to_string(entry.binding);
    require(binding != nullptr, desc.label, "the pipeline '" + desc.pipeline->label() + "' has no " + place);
    const std::string what = place + " ('" + binding->name + "')";
    require(entry.array_element < capacity(interface, *binding), desc.label,
            what + " has " + to_string(capacity(interface, *binding)) + " elements, so there is no element " +
                to_string(entry.array_element));
    require(given[entry.binding].insert(entry.array_element).second, desc.label,
            what + " element " + to_string(entry.array_element) + " is given twice");
    check_resource(entry.resource, *binding, desc.label, what, device);
  }
  for (const ShaderBinding& binding : interface.bindings) {
    if (binding.set != desc.set) continue;
    const std::size_t wanted = capacity(interface, binding);
    const std::size_t count = given[binding.binding].size();
    const bool may_miss = binding.count != 1 && device.capabilities.partially_bound;
    require(count == wanted || may_miss, desc.label,
            "set " + to_string(desc.set) + " binding " + to_string(binding.binding) + " ('" + binding.name +
                "') of pipeline '" + desc.pipeline->label() + "' needs " + to_string(wanted) +
                (wanted == 1 ? " entry, but " : " entries, but ") + to_string(count) +
                (count == 1 ? " is given" : " are given"));
  }
}

}  // namespace tandem::rhi::validation
