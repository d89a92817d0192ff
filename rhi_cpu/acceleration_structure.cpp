#include "rhi_cpu/acceleration_structure.hpp"

#include <array>
#include <cstring>
#include <span>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "rhi/error.hpp"
#include "rhi/validation.hpp"
#include "rhi_cpu/buffer.hpp"

namespace tandem::cpu {
namespace {

std::span<const std::byte> memory(const rhi::BufferRange& range) {
  if (range.empty()) return {};
  const auto& buffer = static_cast<const Buffer&>(*range.buffer);
  return {buffer.data() + range.offset, static_cast<std::size_t>(range.resolved_size())};
}

TriangleInput input_of(const rhi::TriangleGeometry& triangles) {
  TriangleInput input{.vertices = memory(triangles.vertices),
                      .vertex_count = triangles.vertex_count,
                      .vertex_stride = triangles.vertex_stride,
                      .vertex_format = triangles.vertex_format,
                      .indices = memory(triangles.indices),
                      .index_format = triangles.index_format,
                      .triangle_count = triangles.triangle_count,
                      .transform = std::nullopt,
                      .flags = triangles.flags};
  if (!triangles.transform.empty())
    std::memcpy(input.transform.emplace().data(), memory(triangles.transform).data(), sizeof(std::array<float, 12>));
  return input;
}

/// Without the buffers that only a build reads.
rhi::BottomLevelDesc shape_of(rhi::BottomLevelDesc desc) {
  for (rhi::Geometry& geometry : desc.geometries) {
    if (auto* triangles = std::get_if<rhi::TriangleGeometry>(&geometry)) triangles->vertices = triangles->indices = {};
  }
  return desc;
}

void check_owner(const rhi::BufferRange& range, const DeviceState& device) {
  if (!range.empty()) own<Buffer>(range.buffer, device, range.buffer->desc().label);
}

}  // namespace

BottomLevelStructure::BottomLevelStructure(DeviceStateHandle device, const rhi::BottomLevelDesc& desc)
    : AccelerationStructure(Level::bottom, desc.label),
      device_(std::move(device)),
      created_from_(shape_of(desc)),
      address_(device_->bottom_levels.add()) {}

BottomLevelStructure::~BottomLevelStructure() { device_->bottom_levels.remove(address_); }

void BottomLevelStructure::build(const rhi::BottomLevelDesc& desc) {
  std::vector<GeometryInput> inputs;
  for (const rhi::Geometry& geometry : desc.geometries)
    inputs.push_back(input_of(std::get<rhi::TriangleGeometry>(geometry)));
  device_->bottom_levels.set_built(address_, BottomLevel::build(device_->embree, inputs, desc.flags, label()));
}

TopLevelStructure::TopLevelStructure(DeviceStateHandle device, const rhi::TopLevelDesc& desc)
    : AccelerationStructure(Level::top, desc.label), device_(std::move(device)), created_from_(desc) {
  created_from_.instances = {};
}

std::uint64_t TopLevelStructure::device_address() const { return reinterpret_cast<std::uintptr_t>(this); }

void TopLevelStructure::build(const rhi::TopLevelDesc& desc) {
  const std::span<const std::byte> bytes = memory(desc.instances);
  const std::span instances(reinterpret_cast<const rhi::InstanceDesc*>(bytes.data()), desc.instance_count);

  std::unordered_map<std::uint64_t, std::shared_ptr<const BottomLevel>> named;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const std::uint64_t address = instances[i].blas_address;
    if (address == 0 || named.contains(address)) continue;
    const BottomLevelRegistry::Found found = device_->bottom_levels.find(address);
    if (found.built == nullptr)
      throw rhi::Error(rhi::ErrorCode::invalid_argument, label(),
                       fmt::format("instance {} has blas_address {:#x}, which is {}", i, address,
                                   found.lives ? "a bottom level that is not built"
                                               : "no bottom level of this device, or one that no longer lives"));
    named.emplace(address, found.built);
  }
  const auto lookup = [&named](std::uint64_t address) { return named.at(address).get(); };
  built_ = TopLevel::build(device_->embree, instances, lookup, desc.flags, label());
}

void check_owner(const rhi::BottomLevelDesc& desc, const DeviceState& device) {
  for (const rhi::Geometry& geometry : desc.geometries) {
    const auto* triangles = std::get_if<rhi::TriangleGeometry>(&geometry);
    if (triangles == nullptr) continue;
    check_owner(triangles->vertices, device);
    check_owner(triangles->indices, device);
    check_owner(triangles->transform, device);
  }
}

void check_owner(const rhi::TopLevelDesc& desc, const DeviceState& device) { check_owner(desc.instances, device); }

}  // namespace tandem::cpu
