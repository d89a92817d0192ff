#include "rhi/validation.hpp"

#include <algorithm>
#include <string>
#include <string_view>

namespace tandem::rhi::validation {
namespace {

using std::to_string;

[[noreturn]] void fail(std::string_view label, const std::string& why) {
  throw Error(ErrorCode::invalid_argument, label, why);
}

void require(bool holds, std::string_view label, const std::string& why) {
  if (!holds) fail(label, why);
}

std::string name_of(const BufferHandle& buffer) { return "buffer '" + buffer->desc().label + "'"; }

/// `size` bytes from `offset` must lie in the buffer; written so that nothing overflows.
void require_inside(std::string_view label, const BufferHandle& buffer, std::uint64_t offset, std::uint64_t size,
                    const std::string& what) {
  require(buffer != nullptr, label, what + " names no buffer");
  require(offset <= buffer->size() && size <= buffer->size() - offset, label,
          what + " needs bytes [" + to_string(offset) + ", " + to_string(offset) + " + " + to_string(size) + ") of " +
              name_of(buffer) + ", which has " + to_string(buffer->size()));
}

void require_range(std::string_view label, const BufferRange& range, const std::string& what) {
  require(!range.empty(), label, what + " names no buffer");
  require(range.offset < range.buffer->size(), label,
          what + " begins at byte " + to_string(range.offset) + " of " + name_of(range.buffer) + ", which has " +
              to_string(range.buffer->size()));
  require_inside(label, range.buffer, range.offset, range.resolved_size(), what);
}

/// Bytes [range.offset, range.offset + needed) for a build.
void require_build_input(std::string_view label, const BufferRange& range, std::uint64_t needed,
                         std::uint64_t alignment, const std::string& what) {
  require_range(label, range, what);
  require(has(range.buffer->desc().usage, BufferUsage::acceleration_structure_input), label,
          what + ": " + name_of(range.buffer) + " lacks the usage acceleration_structure_input");
  require(range.offset % alignment == 0, label,
          what + " begins at byte " + to_string(range.offset) + ", which is no multiple of " + to_string(alignment));
  require(range.resolved_size() >= needed, label,
          what + " has " + to_string(range.resolved_size()) + " bytes where " + to_string(needed) + " are needed");
}

constexpr std::uint64_t float3_size = 12;
constexpr std::uint64_t transform_size = 48;

void check_triangles(const TriangleGeometry& triangles, std::string_view label, const std::string& what) {
  require(triangles.vertex_stride >= float3_size && triangles.vertex_stride % 4 == 0, label,
          what + " has vertex stride " + to_string(triangles.vertex_stride) +
              ", which must be at least 12 and a multiple of 4");
  if (triangles.triangle_count == 0) return;
  require(triangles.vertex_count > 0, label, what + " has triangles but no vertices");
  const std::uint64_t vertex_bytes =
      (std::uint64_t{triangles.vertex_count} - 1) * triangles.vertex_stride + float3_size;
  require_build_input(label, triangles.vertices, vertex_bytes, 4, what + " vertices");
  const std::uint64_t index_count = std::uint64_t{triangles.triangle_count} * 3;
  if (triangles.index_format == IndexFormat::none) {
    require(triangles.indices.empty(), label, what + " has an index buffer but index format none");
    require(index_count <= triangles.vertex_count, label,
            what + " has " + to_string(triangles.triangle_count) + " triangles without indices but only " +
                to_string(triangles.vertex_count) + " vertices");
  } else {
    const std::uint64_t index_size = triangles.index_format == IndexFormat::uint16 ? 2 : 4;
    require_build_input(label, triangles.indices, index_count * index_size, index_size, what + " indices");
  }
  if (!triangles.transform.empty())
    require_build_input(label, triangles.transform, transform_size, 16, what + " transform");
}

void check_same_shape(std::string_view label, const BottomLevelDesc& created, const BottomLevelDesc& desc) {
  require(created.geometries.size() == desc.geometries.size(), label,
          "a build with " + to_string(desc.geometries.size()) + " geometries of a structure created for " +
              to_string(created.geometries.size()));
  for (std::size_t i = 0; i < desc.geometries.size(); ++i) {
    const auto* a = std::get_if<TriangleGeometry>(&created.geometries[i]);
    const auto* b = std::get_if<TriangleGeometry>(&desc.geometries[i]);
    const bool same = a != nullptr && b != nullptr && a->triangle_count == b->triangle_count &&
                      a->vertex_count == b->vertex_count && a->vertex_format == b->vertex_format &&
                      a->index_format == b->index_format && a->flags == b->flags &&
                      a->transform.empty() == b->transform.empty();
    require(same, label,
            "geometry " + to_string(i) + " has other counts, formats or flags than the structure was created for");
  }
}

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
                    [](const ShaderBinding& x, const ShaderBinding& y) {
                      return x.binding == y.binding && x.kind == y.kind && x.count == y.count;
                    });
}

void check_workgroup_size(const ComputePipelineDesc& desc, const Limits& limits) {
  const ShaderReflection& reflection = desc.shader->reflection();
  std::uint64_t invocations = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    std::uint32_t size = reflection.workgroup_size[i];
    for (const SpecializationValue& given : desc.specialization)
      if (reflection.workgroup_size_constant[i] == given.id) size = given.value;
    require(size > 0 && size <= limits.max_workgroup_size[i], desc.label,
            "a workgroup size of " + to_string(size) + " in dimension " + to_string(i) +
                ", where the device allows 1 to " + to_string(limits.max_workgroup_size[i]));
    invocations *= size;
  }
  require(invocations <= limits.max_workgroup_invocations, desc.label,
          to_string(invocations) + " invocations in a workgroup are more than the device's " +
              to_string(limits.max_workgroup_invocations));
}

}  // namespace

void check(const BufferDesc& desc) { require(desc.size > 0, desc.label, "a buffer must have at least one byte"); }

void check(const BottomLevelDesc& desc, const DeviceInfo& device) {
  require(desc.geometries.size() <= device.limits.max_geometry_count, desc.label,
          to_string(desc.geometries.size()) + " geometries are more than the device's " +
              to_string(device.limits.max_geometry_count));
  std::uint64_t primitive_count = 0;
  for (std::size_t i = 0; i < desc.geometries.size(); ++i) {
    const std::string what = "geometry " + to_string(i);
    if (std::holds_alternative<AabbGeometry>(desc.geometries[i])) {
      continue;
    }
    const auto& triangles = std::get<TriangleGeometry>(desc.geometries[i]);
    check_triangles(triangles, desc.label, what);
    primitive_count += triangles.triangle_count;
  }
  require(primitive_count <= device.limits.max_primitive_count, desc.label,
          to_string(primitive_count) + " triangles are more than the device's " +
              to_string(device.limits.max_primitive_count));
}

void check(const TopLevelDesc& desc, const DeviceInfo& device) {
  require(desc.instance_count <= device.limits.max_instance_count, desc.label,
          to_string(desc.instance_count) + " instances are more than the device's " +
              to_string(device.limits.max_instance_count));
  if (desc.instance_count > 0)
    require_build_input(desc.label, desc.instances, std::uint64_t{desc.instance_count} * sizeof(InstanceDesc), 16,
                        "the instances");
}

void check(const ComputePipelineDesc& desc, const DeviceInfo& device) {
  require(desc.shader != nullptr, desc.label, "a compute pipeline needs a shader");
  const ShaderReflection& reflection = desc.shader->reflection();
  require(reflection.stage == ShaderStage::compute, desc.label,
          "the shader '" + desc.shader->label() + "' is not a compute shader");
  require(reflection.push_constant_size <= device.limits.max_push_constant_size, desc.label,
          "the shader's push constants have " + to_string(reflection.push_constant_size) +
              " bytes, more than the device's " + to_string(device.limits.max_push_constant_size));
  for (std::size_t i = 0; i < desc.specialization.size(); ++i) {
    const std::uint32_t id = desc.specialization[i].id;
    const auto& constants = reflection.specialization_constants;
    require(
        std::any_of(constants.begin(), constants.end(), [id](const SpecializationConstant& c) { return c.id == id; }),
        desc.label, "the shader '" + desc.shader->label() + "' has no specialisation constant " + to_string(id));
    for (std::size_t j = 0; j < i; ++j)
      require(desc.specialization[j].id != id, desc.label,
              "specialisation constant " + to_string(id) + " is given twice");
  }
  check_workgroup_size(desc, device.limits);
  for (const ShaderBinding& binding : reflection.bindings) {
    require(binding.set < device.limits.max_bind_groups, desc.label,
            "the shader uses descriptor set " + to_string(binding.set) + ", but the device has " +
                to_string(device.limits.max_bind_groups));
    const bool bindable = binding.kind == BindingKind::uniform_buffer || binding.kind == BindingKind::storage_buffer ||
                          binding.kind == BindingKind::acceleration_structure;
    if (!bindable)
      throw Error(ErrorCode::unsupported, desc.label,
                  "the shader binds '" + binding.name + "', an image or a sampler, which bind groups cannot hold");
  }
}

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
    if (const auto* range = std::get_if<BufferRange>(&entry.resource)) {
      check_bound_buffer(*range, binding->kind, desc.label, what, device.limits);
    } else {
      const auto& structure = std::get<AccelerationStructureHandle>(entry.resource);
      require(binding->kind == BindingKind::acceleration_structure, desc.label,
              what + " is not an acceleration structure in the shader");
      require(structure != nullptr, desc.label, what + " names no acceleration structure");
      require(structure->level() == AccelerationStructure::Level::top, desc.label,
              what + ": '" + structure->label() + "' is a bottom level, where a shader needs a top level");
    }
  }
  require(desc.entries.size() == wanted, desc.label,
          "set " + to_string(desc.set) + " of pipeline '" + desc.pipeline->label() + "' needs " + to_string(wanted) +
              " entries, but " + to_string(desc.entries.size()) + " are given");
}

void check(const QueryPoolDesc& desc) {
  require(desc.count > 0, desc.label, "a query pool must have at least one query");
}

void check(const DispatchDesc& desc, const DeviceInfo& device) {
  require(desc.pipeline != nullptr, "", "a dispatch needs a pipeline");
  const std::string& label = desc.pipeline->label();
  const PipelineInterface& interface = desc.pipeline->interface();
  require(desc.push_constants.size() == interface.push_constant_size, label,
          "the shader has " + to_string(interface.push_constant_size) +
              " bytes of push constants, but the dispatch gives " + to_string(desc.push_constants.size()));
  for (std::size_t i = 0; i < 3; ++i)
    require(desc.workgroup_count[i] <= device.limits.max_workgroup_count[i], label,
            to_string(desc.workgroup_count[i]) + " workgroups in dimension " + to_string(i) +
                " are more than the device's " + to_string(device.limits.max_workgroup_count[i]));
  std::vector<std::uint32_t> given;
  for (const BindGroupHandle& group : desc.bind_groups) {
    require(group != nullptr, label, "a dispatch names no bind group");
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

void check_build(const CommandList& list, const AccelerationStructureHandle& structure,
                 const BottomLevelDesc& created_from, const BottomLevelDesc& desc) {
  require(structure != nullptr, list.label(), "a build names no acceleration structure");
  require(structure->level() == AccelerationStructure::Level::bottom, structure->label(),
          "build_bottom_level of a top level");
  check_same_shape(structure->label(), created_from, desc);
}

void check_build(const CommandList& list, const AccelerationStructureHandle& structure,
                 const TopLevelDesc& created_from, const TopLevelDesc& desc) {
  require(structure != nullptr, list.label(), "a build names no acceleration structure");
  require(structure->level() == AccelerationStructure::Level::top, structure->label(),
          "build_top_level of a bottom level");
  require(desc.instance_count <= created_from.instance_count, structure->label(),
          "a build with " + to_string(desc.instance_count) + " instances of a structure created for " +
              to_string(created_from.instance_count));
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
