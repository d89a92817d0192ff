#include "rhi_vulkan/acceleration_structure.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <variant>

namespace tandem::vulkan {
namespace {

// The bit fields between the two cannot be asked for their offsets; a test writes them.
static_assert(sizeof(rhi::InstanceDesc) == sizeof(VkAccelerationStructureInstanceKHR));
static_assert(offsetof(rhi::InstanceDesc, object_to_world) == offsetof(VkAccelerationStructureInstanceKHR, transform));
static_assert(offsetof(rhi::InstanceDesc, blas_address) ==
              offsetof(VkAccelerationStructureInstanceKHR, accelerationStructureReference));

constexpr bool equal(rhi::InstanceFlags ours, vk::GeometryInstanceFlagBitsKHR theirs) {
  return static_cast<std::uint32_t>(ours) == static_cast<std::uint32_t>(theirs);
}
static_assert(equal(rhi::InstanceFlags::triangle_facing_cull_disable,
                    vk::GeometryInstanceFlagBitsKHR::eTriangleFacingCullDisable));
static_assert(equal(rhi::InstanceFlags::triangle_flip_facing, vk::GeometryInstanceFlagBitsKHR::eTriangleFlipFacing));
static_assert(equal(rhi::InstanceFlags::force_opaque, vk::GeometryInstanceFlagBitsKHR::eForceOpaque));
static_assert(equal(rhi::InstanceFlags::force_no_opaque, vk::GeometryInstanceFlagBitsKHR::eForceNoOpaque));

vk::GeometryFlagsKHR geometry_flags(rhi::GeometryFlags flags) {
  vk::GeometryFlagsKHR result;
  if (has(flags, rhi::GeometryFlags::opaque)) result |= vk::GeometryFlagBitsKHR::eOpaque;
  if (has(flags, rhi::GeometryFlags::no_duplicate_any_hit))
    result |= vk::GeometryFlagBitsKHR::eNoDuplicateAnyHitInvocation;
  return result;
}

vk::IndexType index_type(rhi::IndexFormat format) {
  switch (format) {
    case rhi::IndexFormat::uint16:
      return vk::IndexType::eUint16;
    case rhi::IndexFormat::uint32:
      return vk::IndexType::eUint32;
    default:
      return vk::IndexType::eNoneKHR;
  }
}

/// The address of the range, 0 when it is empty; the buffer joins the input's.
std::uint64_t address_of(const rhi::BufferRange& range, BuildInput& input, const ContextHandle& context,
                         const std::string& label) {
  if (range.empty()) return 0;
  input.buffers.push_back(range.buffer);
  return own<Buffer>(range.buffer, context, label, "buffer of a build").device_address() + range.offset;
}

void add(const rhi::TriangleGeometry& triangles, BuildInput& input, const ContextHandle& context,
         const std::string& label) {
  const vk::AccelerationStructureGeometryTrianglesDataKHR data = {
      .vertexFormat = vk::Format::eR32G32B32Sfloat,
      .vertexData = {.deviceAddress = address_of(triangles.vertices, input, context, label)},
      .vertexStride = triangles.vertex_stride,
      .maxVertex = std::max(triangles.vertex_count, 1u) - 1,
      .indexType = index_type(triangles.index_format),
      .indexData = {.deviceAddress = address_of(triangles.indices, input, context, label)},
      .transformData = {.deviceAddress = address_of(triangles.transform, input, context, label)}};
  input.geometries.push_back({.geometryType = vk::GeometryTypeKHR::eTriangles,
                              .geometry = {.triangles = data},
                              .flags = geometry_flags(triangles.flags)});
  input.ranges.push_back({.primitiveCount = triangles.triangle_count});
}

/// The desc without what only a build reads. A transform stays: whether there is one is part of the structure's shape.
rhi::BottomLevelDesc without_inputs(rhi::BottomLevelDesc desc) {
  for (rhi::Geometry& geometry : desc.geometries) {
    if (auto* triangles = std::get_if<rhi::TriangleGeometry>(&geometry)) {
      triangles->vertices = {};
      triangles->indices = {};
    }
  }
  return desc;
}

}  // namespace

vk::AccelerationStructureBuildGeometryInfoKHR BuildInput::info() const {
  return {.type = type,
          .flags = vk::BuildAccelerationStructureFlagBitsKHR::ePreferFastTrace,
          .mode = vk::BuildAccelerationStructureModeKHR::eBuild,
          .geometryCount = static_cast<std::uint32_t>(geometries.size()),
          .pGeometries = geometries.data()};
}

BuildInput build_input(const rhi::BottomLevelDesc& desc, const ContextHandle& context, const std::string& label) {
  BuildInput input;
  for (const rhi::Geometry& geometry : desc.geometries) {
    if (const auto* triangles = std::get_if<rhi::TriangleGeometry>(&geometry))
      add(*triangles, input, context, label);
    else
      throw rhi::Error(rhi::ErrorCode::unsupported, label, "this device builds no boxes");
  }
  return input;
}

BuildInput build_input(const rhi::TopLevelDesc& desc, const ContextHandle& context, const std::string& label) {
  BuildInput input;
  input.type = vk::AccelerationStructureTypeKHR::eTopLevel;
  const vk::AccelerationStructureGeometryInstancesDataKHR data = {
      .data = {.deviceAddress = address_of(desc.instances, input, context, label)}};
  input.geometries.push_back({.geometryType = vk::GeometryTypeKHR::eInstances, .geometry = {.instances = data}});
  input.ranges.push_back({.primitiveCount = desc.instance_count});
  return input;
}

AccelerationStructure::AccelerationStructure(ContextHandle context, const rhi::BottomLevelDesc& desc)
    : rhi::AccelerationStructure(Level::bottom, desc.label),
      context_(std::move(context)),
      bottom_level_desc_(without_inputs(desc)) {
  create(build_input(desc, context_, desc.label));
}

AccelerationStructure::AccelerationStructure(ContextHandle context, const rhi::TopLevelDesc& desc)
    : rhi::AccelerationStructure(Level::top, desc.label), context_(std::move(context)) {
  top_level_desc_.instance_count = desc.instance_count;
  create(build_input(desc, context_, desc.label));
}

void AccelerationStructure::create(const BuildInput& input) {
  using Usage = vk::BufferUsageFlagBits;
  translating_errors(label(), "create the acceleration structure", [&] {
    std::vector<std::uint32_t> primitive_counts;
    for (const vk::AccelerationStructureBuildRangeInfoKHR& range : input.ranges)
      primitive_counts.push_back(range.primitiveCount);
    const vk::AccelerationStructureBuildSizesInfoKHR sizes = context_->device.getAccelerationStructureBuildSizesKHR(
        vk::AccelerationStructureBuildTypeKHR::eDevice, input.info(), primitive_counts);
    scratch_size_ = std::max<std::uint64_t>(sizes.buildScratchSize, 1);
    buffer_ = make_backed_buffer(*context_, sizes.accelerationStructureSize,
                                 Usage::eAccelerationStructureStorageKHR | Usage::eShaderDeviceAddress,
                                 MemoryKind::device, label());
    structure_ = context_->device.createAccelerationStructureKHR(
        {.buffer = *buffer_.handle, .size = sizes.accelerationStructureSize, .type = input.type});
    context_->name(structure_, label());
    address_ = context_->device.getAccelerationStructureAddressKHR({.accelerationStructure = *structure_});
  });
}

}  // namespace tandem::vulkan
