#include <string>
#include <string_view>

#include "rhi/validation.hpp"
#include "rhi/validation/require.hpp"

namespace tandem::rhi::validation {
namespace {

using std::to_string;

/// Bytes [range.offset, range.offset + needed) for a build.
void require_build_input(std::string_view label, const BufferRange& range, std::uint64_t needed,
                         std::uint64_t alignment, const std::string& what) {
  require_range(label, range, what);
  require_usage(label, range, BufferUsage::acceleration_structure_input, "acceleration_structure_input", what);
  require_alignment(label, range, alignment, what);
  require(range.resolved_size() >= needed, label,
          what + " has " + to_string(range.resolved_size()) + " bytes where " + to_string(needed) + " are needed");
}

constexpr std::uint64_t transform_size = 48;
constexpr std::uint64_t box_size = 24;

void check(const TriangleGeometry& triangles, std::string_view label, const std::string& what) {
  const std::uint32_t position_size = size_of(triangles.vertex_format);
  const std::uint32_t component_size = component_size_of(triangles.vertex_format);
  require(triangles.vertex_stride >= position_size && triangles.vertex_stride % component_size == 0, label,
          what + " has vertex stride " + to_string(triangles.vertex_stride) + ", which must be at least " +
              to_string(position_size) + " and a multiple of " + to_string(component_size));
  if (triangles.triangle_count == 0) return;
  require(triangles.vertex_count > 0, label, what + " has triangles but no vertices");
  const std::uint64_t vertex_bytes =
      (std::uint64_t{triangles.vertex_count} - 1) * triangles.vertex_stride + position_size;
  require_build_input(label, triangles.vertices, vertex_bytes, component_size, what + " vertices");
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

void check(const AabbGeometry& boxes, std::string_view label, const std::string& what) {
  require(boxes.stride >= box_size && boxes.stride % 8 == 0, label,
          what + " has a stride of " + to_string(boxes.stride) + ", which must be at least 24 and a multiple of 8");
  if (boxes.box_count == 0) return;
  const std::uint64_t bytes = (std::uint64_t{boxes.box_count} - 1) * boxes.stride + box_size;
  require_build_input(label, boxes.boxes, bytes, 8, what + " boxes");
}

void check_flags(BuildFlags flags, std::string_view label) {
  require(!has(flags, BuildFlags::prefer_fast_trace | BuildFlags::prefer_fast_build), label,
          "prefer_fast_trace and prefer_fast_build exclude each other");
}

std::uint32_t primitive_count(const Geometry& geometry) {
  const auto* triangles = std::get_if<TriangleGeometry>(&geometry);
  return triangles != nullptr ? triangles->triangle_count : std::get<AabbGeometry>(geometry).box_count;
}

bool same_shape(const TriangleGeometry& a, const TriangleGeometry& b) {
  return a.triangle_count == b.triangle_count && a.vertex_count == b.vertex_count &&
         a.vertex_format == b.vertex_format && a.index_format == b.index_format && a.flags == b.flags &&
         a.transform.empty() == b.transform.empty();
}

bool same_shape(const AabbGeometry& a, const AabbGeometry& b) {
  return a.box_count == b.box_count && a.flags == b.flags;
}

bool same_shape(const Geometry& a, const Geometry& b) {
  if (a.index() != b.index()) return false;
  if (const auto* triangles = std::get_if<TriangleGeometry>(&a))
    return same_shape(*triangles, std::get<TriangleGeometry>(b));
  return same_shape(std::get<AabbGeometry>(a), std::get<AabbGeometry>(b));
}

void check_same_flags(std::string_view label, BuildFlags created, BuildFlags given) {
  require(created == given, label, "a build has other flags than the structure was created with");
}

void check_level(const CommandList& list, const AccelerationStructureHandle& structure,
                 AccelerationStructure::Level level) {
  require(structure != nullptr, list.label(), "a build names no acceleration structure");
  const bool wants_bottom = level == AccelerationStructure::Level::bottom;
  require(structure->level() == level, structure->label(),
          wants_bottom ? "a bottom level is built, but this is a top level"
                       : "a top level is built, but this is a bottom level");
}

void check_updatable(const AccelerationStructureHandle& structure, BuildFlags flags) {
  require(has(flags, BuildFlags::allow_update), structure->label(),
          "it is updated, but was created without BuildFlags::allow_update");
}

}  // namespace

void check(const BottomLevelDesc& desc, const DeviceInfo& device) {
  check_flags(desc.flags, desc.label);
  require_limit(desc.geometries.size(), device.limits.max_geometry_count, desc.label, "geometries");
  std::uint64_t primitives = 0;
  for (std::size_t i = 0; i < desc.geometries.size(); ++i) {
    const Geometry& geometry = desc.geometries[i];
    const std::string what = "geometry " + to_string(i);
    require(geometry.index() == desc.geometries[0].index(), desc.label,
            what + " is of another kind than geometry 0: a bottom level holds triangles or boxes, not both");
    std::visit([&](const auto& each) { check(each, desc.label, what); }, geometry);
    primitives += primitive_count(geometry);
  }
  require_limit(primitives, device.limits.max_primitive_count, desc.label, "primitives");
}

void check(const TopLevelDesc& desc, const DeviceInfo& device) {
  check_flags(desc.flags, desc.label);
  require_limit(desc.instance_count, device.limits.max_instance_count, desc.label, "instances");
  if (desc.instance_count > 0)
    require_build_input(desc.label, desc.instances, std::uint64_t{desc.instance_count} * sizeof(InstanceDesc), 16,
                        "the instances");
}

void check_build(const CommandList& list, const AccelerationStructureHandle& structure,
                 const BottomLevelDesc& created_from, const BottomLevelDesc& desc) {
  check_level(list, structure, AccelerationStructure::Level::bottom);
  check_same_flags(structure->label(), created_from.flags, desc.flags);
  require(created_from.geometries.size() == desc.geometries.size(), structure->label(),
          "a build with " + to_string(desc.geometries.size()) + " geometries of a structure created for " +
              to_string(created_from.geometries.size()));
  for (std::size_t i = 0; i < desc.geometries.size(); ++i)
    require(same_shape(created_from.geometries[i], desc.geometries[i]), structure->label(),
            "geometry " + to_string(i) + " has other counts, formats or flags than the structure was created for");
}

void check_build(const CommandList& list, const AccelerationStructureHandle& structure,
                 const TopLevelDesc& created_from, const TopLevelDesc& desc) {
  check_level(list, structure, AccelerationStructure::Level::top);
  check_same_flags(structure->label(), created_from.flags, desc.flags);
  require(desc.instance_count <= created_from.instance_count, structure->label(),
          "a build with " + to_string(desc.instance_count) + " instances of a structure created for " +
              to_string(created_from.instance_count));
}

void check_update(const CommandList& list, const AccelerationStructureHandle& structure,
                  const BottomLevelDesc& created_from, const BottomLevelDesc& desc) {
  check_build(list, structure, created_from, desc);
  check_updatable(structure, created_from.flags);
}

void check_update(const CommandList& list, const AccelerationStructureHandle& structure,
                  const TopLevelDesc& created_from, const TopLevelDesc& desc) {
  check_build(list, structure, created_from, desc);
  check_updatable(structure, created_from.flags);
}

void check_compaction(const AccelerationStructureHandle& source, BuildFlags flags, const std::string& label) {
  require(source != nullptr, label, "a compaction names no acceleration structure");
  require(has(flags, BuildFlags::allow_compaction), label,
          "'" + source->label() + "' is compacted, but was created without BuildFlags::allow_compaction");
}

}  // namespace tandem::rhi::validation
