#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "rhi/validation.hpp"
#include "rhi/validation/require.hpp"

namespace tandem::rhi::validation {
namespace {

using std::to_string;

bool same_layout(const PipelineInterface& a, const PipelineInterface& b, std::uint32_t set) {
  const auto in_set = [set](const PipelineInterface& interface) {
    std::vector<ShaderBinding> bindings;
    std::copy_if(interface.bindings.begin(), interface.bindings.end(), std::back_inserter(bindings),
                 [set](const ShaderBinding& binding) { return binding.set == set; });
    return bindings;
  };
  const std::vector<ShaderBinding> first = in_set(a);
  const std::vector<ShaderBinding> second = in_set(b);
  return std::equal(first.begin(), first.end(), second.begin(), second.end(),
                    [&](const ShaderBinding& x, const ShaderBinding& y) {
                      return x.binding == y.binding && x.kind == y.kind && x.count == y.count &&
                             capacity(a, x) == capacity(b, y) && x.dimension == y.dimension && x.format == y.format;
                    });
}

/// What a dispatch and a trace bind. @param what of the two it is, for the sentence
void check_bindings(const Pipeline& pipeline, const std::vector<BindGroupHandle>& bind_groups,
                    std::size_t push_constant_size, const std::string& what) {
  const std::string& label = pipeline.label();
  const PipelineInterface& interface = pipeline.interface();
  require(push_constant_size == interface.push_constant_size, label,
          "the shader has " + to_string(interface.push_constant_size) + " bytes of push constants, but the " + what +
              " gives " + to_string(push_constant_size));
  std::vector<std::uint32_t> given;
  for (const BindGroupHandle& group : bind_groups) {
    require(group != nullptr, label, "a " + what + " names no bind group");
    const std::uint32_t set = group->desc().set;
    require(std::find(given.begin(), given.end(), set) == given.end(), label,
            "set " + to_string(set) + " is given twice");
    require(same_layout(group->desc().pipeline->interface(), interface, set), label,
            "bind group '" + group->label() + "' was made for other bindings of set " + to_string(set));
    given.push_back(set);
  }
  for (const ShaderBinding& binding : interface.bindings)
    require(std::find(given.begin(), given.end(), binding.set) != given.end(), label,
            "no bind group is given for set " + to_string(binding.set));
}

void check_first_record(std::uint32_t first, const ShaderRecords& records, const std::string& label,
                        const std::string& kind) {
  require(first <= records.records.size(), label,
          "a trace begins at " + kind + " record " + to_string(first) + " of a table that has " +
              to_string(records.records.size()));
}

/// Three uint32 in a buffer.
void check_indirect(const BufferRange& range, const std::string& label, const std::string& what) {
  constexpr std::uint64_t bytes = 12;
  require_range(label, range, what);
  require_usage(label, range, BufferUsage::indirect, "indirect", what);
  require_alignment(label, range, 4, what);
  require(range.resolved_size() >= bytes, label,
          what + " has " + to_string(range.resolved_size()) + " bytes where 12 are needed");
}

}  // namespace

void check(const BufferDesc& desc) { require(desc.size > 0, desc.label, "a buffer must have at least one byte"); }

void check(const QueryPoolDesc& desc) {
  require(desc.count > 0, desc.label, "a query pool must have at least one query");
}

void check(const TextureDesc& desc, const DeviceInfo& device) {
  const std::uint32_t sides = side_count(desc.dimension);
  const Limits& limits = device.limits;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t size = desc.size[i];
    require(size > 0, desc.label, "a texture of size 0 in dimension " + to_string(i));
    if (i == 2 && is_layered(desc.dimension))
      require_limit(size, limits.max_texture_layers, desc.label, "layers of a texture");
    else if (i < sides)
      require_limit(size, limits.max_texture_size[static_cast<std::size_t>(desc.dimension)], desc.label,
                    "texels along a side of a texture");
    else
      require(size == 1, desc.label,
              "a texture has size " + to_string(size) + " in dimension " + to_string(i) + ", which its kind lacks");
  }
  if (desc.dimension == TextureDimension::cube || desc.dimension == TextureDimension::cube_array) {
    require(desc.size[0] == desc.size[1], desc.label, "the faces of a cube are not square");
    require(desc.dimension == TextureDimension::cube ? desc.size[2] == 6 : desc.size[2] % 6 == 0, desc.label,
            to_string(desc.size[2]) + " layers, where each cube has 6");
  }
  require(desc.level_count > 0, desc.label, "a texture needs at least one level");
  require_limit(desc.level_count, full_level_count(desc), desc.label, "levels of a texture of this size");
}

void check(const SamplerDesc& desc) {
  require(std::isfinite(desc.lod_bias), desc.label, "the bias of a sampler's level of detail is no number");
  require(desc.min_lod <= desc.max_lod, desc.label, "a sampler's smallest level of detail is above its largest");
  if (!desc.unnormalized_coordinates) return;
  const auto clamps = [](AddressMode mode) {
    return mode == AddressMode::clamp_to_edge || mode == AddressMode::clamp_to_border;
  };
  require(
      desc.magnification == desc.minification && desc.mipmap == Filter::nearest && desc.min_lod == 0 &&
          desc.max_lod == 0 && clamps(desc.address[0]) && clamps(desc.address[1]) && !desc.compare,
      desc.label,
      "a sampler with unnormalised coordinates has equal filters, min_lod and max_lod 0, clamped addresses of u and v, "
      "and no comparison");
}

void check(const DispatchDesc& desc, const DeviceInfo& device) {
  require(desc.pipeline != nullptr, "", "a dispatch needs a pipeline");
  for (std::size_t i = 0; i < 3; ++i)
    require(desc.workgroup_count[i] <= device.limits.max_workgroup_count[i], desc.pipeline->label(),
            to_string(desc.workgroup_count[i]) + " workgroups in dimension " + to_string(i) +
                " are more than the device's " + to_string(device.limits.max_workgroup_count[i]));
  check_bindings(*desc.pipeline, desc.bind_groups, desc.push_constants.size(), "dispatch");
  const std::string& label = desc.pipeline->label();
  if (!desc.indirect_count.empty()) {
    check_indirect(desc.indirect_count, label, "the indirect count of a dispatch");
    require(desc.base_workgroup == std::array<std::uint32_t, 3>{}, label,
            "an indirect dispatch begins at workgroup 0, 0, 0");
    return;
  }
  for (std::size_t i = 0; i < 3; ++i)
    require_limit(std::uint64_t{desc.base_workgroup[i]} + desc.workgroup_count[i], device.limits.max_workgroup_count[i],
                  label, "workgroups up to the last in dimension " + to_string(i));
}

void check(const TraceRaysDesc& desc, const DeviceInfo& device) {
  require(desc.table != nullptr, "", "a trace needs a shader table");
  const ShaderTableDesc& table = desc.table->desc();
  const std::string& label = desc.table->label();
  require(desc.ray_generation_record < table.ray_generation.records.size(), label,
          "a trace begins with ray generation record " + to_string(desc.ray_generation_record) +
              " of a table that has " + to_string(table.ray_generation.records.size()));
  check_first_record(desc.first_miss_record, table.miss, label, "miss");
  check_first_record(desc.first_hit_record, table.hit, label, "hit");
  check_first_record(desc.first_callable_record, table.callable, label, "callable");
  check_bindings(*table.pipeline, desc.bind_groups, desc.push_constants.size(), "trace");
  if (!desc.indirect_size.empty()) {
    if (!device.capabilities.trace_rays_indirect)
      throw Error(ErrorCode::unsupported, label, "device '" + device.name + "' has no indirect traces");
    return check_indirect(desc.indirect_size, label, "the indirect size of a trace");
  }
  std::uint64_t invocations = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    // Vulkan: at most maxComputeWorkGroupCount * maxComputeWorkGroupSize in each dimension.
    const std::uint64_t limit =
        std::uint64_t{device.limits.max_workgroup_count[i]} * device.limits.max_workgroup_size[i];
    require_limit(desc.size[i], limit, label, "invocations in dimension " + to_string(i));
    // Two factors of 32 bits cannot overflow, and the third only multiplies what is below the limit.
    if (invocations > 0 && desc.size[i] > 0 && invocations > device.limits.max_ray_invocations / desc.size[i])
      require(false, label,
              "a trace of " + to_string(desc.size[0]) + " x " + to_string(desc.size[1]) + " x " +
                  to_string(desc.size[2]) + " has more than the device's " +
                  to_string(device.limits.max_ray_invocations) + " invocations");
    invocations *= desc.size[i];
  }
}

void check_upload(const CommandList& list, const BufferHandle& buffer, std::uint64_t offset, std::uint64_t size) {
  require_inside(list.label(), buffer, offset, size, "upload");
}

void check_copy(const CommandList& list, const BufferRange& source, const BufferRange& destination) {
  require_range(list.label(), source, "the source of a copy");
  require_range(list.label(), destination, "the destination of a copy");
  const std::uint64_t size = source.resolved_size();
  require(size == destination.resolved_size(), list.label(),
          "a copy from " + to_string(size) + " bytes to " + to_string(destination.resolved_size()));
  const bool overlap = source.buffer == destination.buffer && source.offset < destination.offset + size &&
                       destination.offset < source.offset + size;
  require(!overlap, list.label(), "a copy within " + name_of(source.buffer) + " overlaps itself");
}

void check_fill(const CommandList& list, const BufferRange& range) {
  require_range(list.label(), range, "fill");
  require(range.offset % 4 == 0 && range.resolved_size() % 4 == 0, list.label(),
          "a fill must begin at a multiple of 4 bytes and have a multiple of 4");
}

void check_texture_copy(const CommandList& list, const BufferRange& range, const TextureHandle& texture) {
  require(texture != nullptr, list.label(), "a copy names no texture");
  const std::string what = "the buffer of a copy with texture '" + texture->desc().label + "'";
  require_range(list.label(), range, what);
  require_alignment(list.label(), range, 16, what);
  require(range.resolved_size() == texture->size_in_bytes(), list.label(),
          what + " has " + to_string(range.resolved_size()) + " bytes where the texture has " +
              to_string(texture->size_in_bytes()));
}

void check_timestamp(const CommandList& list, const QueryPoolHandle& pool, std::uint32_t index) {
  require(pool != nullptr, list.label(), "write_timestamp names no query pool");
  require(index < pool->desc().count, pool->desc().label,
          "query " + to_string(index) + " of a pool of " + to_string(pool->desc().count));
}

void check_download(const BufferHandle& buffer, std::uint64_t offset, std::uint64_t size) {
  require_inside("", buffer, offset, size, "download");
}

}  // namespace tandem::rhi::validation
