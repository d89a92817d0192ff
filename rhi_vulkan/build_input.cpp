#include "rhi_vulkan/build_input.hpp"

#include <algorithm>
#include <variant>

#include "rhi_vulkan/buffer.hpp"

namespace tandem::vulkan {
namespace {

constexpr bool equal(rhi::BuildFlags ours, vk::BuildAccelerationStructureFlagBitsKHR theirs) {
  return static_cast<std::uint32_t>(ours) == static_cast<std::uint32_t>(theirs);
}
static_assert(equal(rhi::BuildFlags::allow_update, vk::BuildAccelerationStructureFlagBitsKHR::eAllowUpdate));
static_assert(equal(rhi::BuildFlags::allow_compaction, vk::BuildAccelerationStructureFlagBitsKHR::eAllowCompaction));
static_assert(equal(rhi::BuildFlags::prefer_fast_trace, vk::BuildAccelerationStructureFlagBitsKHR::ePreferFastTrace));
static_assert(equal(rhi::BuildFlags::prefer_fast_build, vk::BuildAccelerationStructureFlagBitsKHR::ePreferFastBuild));

vk::BuildAccelerationStructureFlagsKHR build_flags(rhi::BuildFlags flags) {
  return vk::BuildAccelerationStructureFlagsKHR(static_cast<std::uint32_t>(flags));
}

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

/// `exact` where the device builds from it, else `padded`, which every device builds from: its fourth component is
/// ignored. (lavapipe 25.0.7 offers the first for halves, and does not ignore a NaN in the fourth of the second.)
vk::Format three_components(const PhysicalDevice& device, vk::Format exact, vk::Format padded) {
  const vk::FormatFeatureFlags features = device.handle.getFormatProperties(exact).bufferFeatures;
  return features & vk::FormatFeatureFlagBits::eAccelerationStructureVertexBufferKHR ? exact : padded;
}

vk::Format vertex_format(rhi::VertexFormat format, const PhysicalDevice& device) {
  switch (format) {
    case rhi::VertexFormat::half3:
      return three_components(device, vk::Format::eR16G16B16Sfloat, vk::Format::eR16G16B16A16Sfloat);
    case rhi::VertexFormat::snorm3:
      return three_components(device, vk::Format::eR16G16B16Snorm, vk::Format::eR16G16B16A16Snorm);
    default:
      return vk::Format::eR32G32B32Sfloat;
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
      .vertexFormat = vertex_format(triangles.vertex_format, context->physical),
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

void add(const rhi::AabbGeometry& boxes, BuildInput& input, const ContextHandle& context, const std::string& label) {
  const vk::AccelerationStructureGeometryAabbsDataKHR data = {
      .data = {.deviceAddress = address_of(boxes.boxes, input, context, label)}, .stride = boxes.stride};
  input.geometries.push_back(
      {.geometryType = vk::GeometryTypeKHR::eAabbs, .geometry = {.aabbs = data}, .flags = geometry_flags(boxes.flags)});
  input.ranges.push_back({.primitiveCount = boxes.box_count});
}

}  // namespace

vk::AccelerationStructureBuildGeometryInfoKHR BuildInput::info() const {
  return {.type = type,
          .flags = flags,
          .mode = vk::BuildAccelerationStructureModeKHR::eBuild,
          .geometryCount = static_cast<std::uint32_t>(geometries.size()),
          .pGeometries = geometries.data()};
}

BuildInput build_input(const rhi::BottomLevelDesc& desc, const ContextHandle& context, const std::string& label) {
  BuildInput input;
  input.flags = build_flags(desc.flags);
  for (const rhi::Geometry& geometry : desc.geometries)
    std::visit([&](const auto& each) { add(each, input, context, label); }, geometry);
  return input;
}

BuildInput build_input(const rhi::TopLevelDesc& desc, const ContextHandle& context, const std::string& label) {
  BuildInput input;
  input.type = vk::AccelerationStructureTypeKHR::eTopLevel;
  input.flags = build_flags(desc.flags);
  const vk::AccelerationStructureGeometryInstancesDataKHR data = {
      .data = {.deviceAddress = address_of(desc.instances, input, context, label)}};
  input.geometries.push_back({.geometryType = vk::GeometryTypeKHR::eInstances, .geometry = {.instances = data}});
  input.ranges.push_back({.primitiveCount = desc.instance_count});
  return input;
}

}  // namespace tandem::vulkan
