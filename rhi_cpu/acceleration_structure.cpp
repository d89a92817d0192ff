#include "rhi_cpu/acceleration_structure.hpp"

#include <array>
#include <cstring>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "rhi/error.hpp"
#include "rhi/validation.hpp"
#include "rhi/validation/built.hpp"
#include "rhi_cpu/buffer.hpp"

namespace tandem::cpu {
namespace {

std::span<const std::byte> memory(const rhi::BufferRange& range) {
  if (range.empty()) return {};
  const auto& buffer = static_cast<const Buffer&>(*range.buffer);
  return {buffer.data() + range.offset, static_cast<std::size_t>(range.resolved_size())};
}

GeometryInput input_of(const rhi::TriangleGeometry& triangles) {
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

GeometryInput input_of(const rhi::AabbGeometry& boxes) {
  return BoxInput{
      .boxes = memory(boxes.boxes), .box_count = boxes.box_count, .stride = boxes.stride, .flags = boxes.flags};
}

std::vector<GeometryInput> inputs_of(const rhi::BottomLevelDesc& desc) {
  std::vector<GeometryInput> inputs;
  for (const rhi::Geometry& geometry : desc.geometries)
    inputs.push_back(std::visit([](const auto& each) { return GeometryInput(input_of(each)); }, geometry));
  return inputs;
}

/// Without the buffers that only a build reads.
rhi::BottomLevelDesc shape_of(rhi::BottomLevelDesc desc) {
  for (rhi::Geometry& geometry : desc.geometries) {
    if (auto* triangles = std::get_if<rhi::TriangleGeometry>(&geometry))
      triangles->vertices = triangles->indices = {};
    else
      std::get<rhi::AabbGeometry>(geometry).boxes = {};
  }
  return desc;
}

void check_owner(const rhi::BufferRange& range, const DeviceState& device) {
  if (!range.empty()) own<Buffer>(range.buffer, device, range.buffer->desc().label);
}

void check_owner(const rhi::TriangleGeometry& triangles, const DeviceState& device) {
  check_owner(triangles.vertices, device);
  check_owner(triangles.indices, device);
  check_owner(triangles.transform, device);
}

void check_owner(const rhi::AabbGeometry& boxes, const DeviceState& device) { check_owner(boxes.boxes, device); }

template <typename Desc>
Desc relabelled(Desc desc, std::string label) {
  desc.label = std::move(label);
  return desc;
}

template <typename Built>
rhi::AccelerationStructureSizes sizes_of(const Built& built, DeviceState& device) {
  // Scratch memory is the tracers' own business.
  const std::lock_guard lock(device.submission);
  return {.structure = built != nullptr ? bytes_of(*built) : 0};
}

}  // namespace

BottomLevelStructure::BottomLevelStructure(DeviceStateHandle device, const rhi::BottomLevelDesc& desc)
    : AccelerationStructure(Level::bottom, desc.label),
      device_(std::move(device)),
      created_from_(shape_of(desc)),
      address_(device_->bottom_levels.add()) {}

BottomLevelStructure::~BottomLevelStructure() { device_->bottom_levels.remove(address_); }

rhi::AccelerationStructureSizes BottomLevelStructure::sizes() const { return sizes_of(built_, *device_); }

void BottomLevelStructure::build(const rhi::BottomLevelDesc& desc) {
  set_built(
      std::make_shared<BuiltBottomLevel>(device_->tracer.build_bottom_level(inputs_of(desc), desc.flags, label())));
}

void BottomLevelStructure::update(const rhi::BottomLevelDesc& desc) {
  rhi::validation::check_updated(*this, built_ != nullptr ? std::optional(0u) : std::nullopt, 0);
  // What a compacted copy shares must not change with this one.
  if (built_.use_count() > 1)
    build(desc);
  else
    device_->tracer.update_bottom_level(*built_, inputs_of(desc), label());
}

std::shared_ptr<BottomLevelStructure> BottomLevelStructure::compacted(std::string label) const {
  rhi::validation::check_compacted(*this, built_ != nullptr, label);
  auto copy = std::make_shared<BottomLevelStructure>(device_, relabelled(created_from_, std::move(label)));
  copy->set_built(built_);
  copy->is_compacted_ = true;
  return copy;
}

void BottomLevelStructure::set_built(std::shared_ptr<BuiltBottomLevel> built) {
  built_ = std::move(built);
  device_->bottom_levels.set_built(address_, built_);
}

TopLevelStructure::TopLevelStructure(DeviceStateHandle device, const rhi::TopLevelDesc& desc)
    : AccelerationStructure(Level::top, desc.label), device_(std::move(device)), created_from_(desc) {
  created_from_.instances = {};
}

std::uint64_t TopLevelStructure::device_address() const { return reinterpret_cast<std::uintptr_t>(&addressed_); }

void TopLevelStructure::set_built(std::shared_ptr<const BuiltTopLevel> built) {
  built_ = std::move(built);
  addressed_.top_level = view();
}

rhi::AccelerationStructureSizes TopLevelStructure::sizes() const { return sizes_of(built_, *device_); }

void TopLevelStructure::build(const rhi::TopLevelDesc& desc) {
  const std::span<const std::byte> bytes = memory(desc.instances);
  const std::span instances(reinterpret_cast<const rhi::InstanceDesc*>(bytes.data()), desc.instance_count);

  std::unordered_map<std::uint64_t, std::shared_ptr<const BuiltBottomLevel>> named;
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
  set_built(
      std::make_shared<const BuiltTopLevel>(device_->tracer.build_top_level(instances, lookup, desc.flags, label())));
}

void TopLevelStructure::update(const rhi::TopLevelDesc& desc) {
  rhi::validation::check_updated(*this, built_ != nullptr ? std::optional(view()->instance_count) : std::nullopt,
                                 desc.instance_count);
  build(desc);
}

std::shared_ptr<TopLevelStructure> TopLevelStructure::compacted(std::string label) const {
  rhi::validation::check_compacted(*this, built_ != nullptr, label);
  auto copy = std::make_shared<TopLevelStructure>(device_, relabelled(created_from_, std::move(label)));
  copy->set_built(built_);
  copy->is_compacted_ = true;
  return copy;
}

void check_owner(const rhi::BottomLevelDesc& desc, const DeviceState& device) {
  for (const rhi::Geometry& geometry : desc.geometries)
    std::visit([&device](const auto& each) { check_owner(each, device); }, geometry);
}

void check_owner(const rhi::TopLevelDesc& desc, const DeviceState& device) { check_owner(desc.instances, device); }

}  // namespace tandem::cpu
