#include "program/execute/resources.hpp"

#include <algorithm>
#include <cstring>
#include <span>

#include <fmt/format.h>

#include "program/execute/position.hpp"
#include "rhi/build.hpp"
#include "rhi/transfer.hpp"

namespace tandem::program {
namespace {

constexpr auto build_input = rhi::BufferUsage::acceleration_structure_input;

/// A buffer of values that a build reads; none without values.
template <typename Values>
rhi::BufferRange input_of(rhi::Device& device, const Values& values, const std::string& label) {
  return values.empty() ? rhi::BufferRange{} : rhi::BufferRange{rhi::create_filled(device, values, build_input, label)};
}

rhi::Geometry make_geometry(rhi::Device& device, const Triangles& triangles, const std::string& label) {
  const std::size_t corners = triangles.indices.empty() ? triangles.positions.size() : triangles.indices.size();
  for (const std::uint32_t index : triangles.indices)
    if (index >= triangles.positions.size())
      throw rhi::Error(rhi::ErrorCode::invalid_argument, label,
                       fmt::format("index {} of {} positions", index, triangles.positions.size()));
  return rhi::TriangleGeometry{
      .vertices = input_of(device, triangles.positions, label + ", positions"),
      .vertex_count = static_cast<std::uint32_t>(triangles.positions.size()),
      .indices = input_of(device, triangles.indices, label + ", indices"),
      .index_format = triangles.indices.empty() ? rhi::IndexFormat::none : rhi::IndexFormat::uint32,
      .triangle_count = static_cast<std::uint32_t>(corners / 3),
      .transform = {},
      .flags = triangles.flags};
}

rhi::Geometry make_geometry(rhi::Device& device, const Boxes& boxes, const std::string& label) {
  return rhi::AabbGeometry{.boxes = input_of(device, boxes.boxes, label + ", boxes"),
                           .box_count = static_cast<std::uint32_t>(boxes.boxes.size()),
                           .flags = boxes.flags};
}

rhi::AccelerationStructureHandle make_bottom_level(rhi::Device& device, const BottomLevel& level) {
  rhi::BottomLevelDesc desc{.geometries = {}, .label = level.name};
  for (const auto& geometry : level.geometries) {
    const std::string label = fmt::format("{}, geometry {}", level.name, desc.geometries.size());
    desc.geometries.push_back(
        std::visit([&](const auto& each) { return make_geometry(device, each, label); }, geometry));
  }
  return rhi::build_bottom_level(device, desc);
}

rhi::AccelerationStructureHandle make_top_level(rhi::Device& device, const Resources& resources,
                                                const TopLevel& level) {
  std::vector<rhi::InstanceDesc> instances;
  for (const Instance& instance : level.instances) {
    rhi::InstanceDesc desc =
        rhi::make_instance(*at_position(resources.bottom_levels, instance.bottom_level, level.name, "bottom level"),
                           instance.object_to_world);
    desc.custom_index = instance.custom_index & 0xffffff;
    desc.mask = instance.mask & 0xff;
    desc.sbt_offset = instance.sbt_offset & 0xffffff;
    desc.flags = static_cast<std::uint32_t>(instance.flags) & 0xff;
    instances.push_back(desc);
  }
  return rhi::build_top_level(device, {.instances = input_of(device, instances, level.name + ", instances"),
                                       .instance_count = static_cast<std::uint32_t>(instances.size()),
                                       .label = level.name});
}

/// What the pipelines of the job bind the buffer as.
rhi::BufferUsage usage_of(const Job& job, std::size_t buffer) {
  rhi::BufferUsage usage = rhi::BufferUsage::storage | rhi::BufferUsage::uniform;
  for (const Pipeline& pipeline : job.pipelines)
    for (const Binding& binding : pipeline.bindings)
      if (const auto* texels = std::get_if<TexelBufferUse>(&binding.resource); texels && texels->buffer == buffer)
        usage |= rhi::BufferUsage::uniform_texels | rhi::BufferUsage::storage_texels;
  return usage;
}

rhi::TextureHandle make_image(rhi::Device& device, const Image& image) {
  if (!image.initial.empty()) return rhi::create_filled(device, image.initial, image.desc);
  const std::uint64_t size = rhi::level_offset(image.desc, image.desc.level_count - 1) +
                             rhi::level_size_in_bytes(image.desc, image.desc.level_count - 1);
  return rhi::create_filled(device, std::vector<std::byte>(static_cast<std::size_t>(size)), image.desc);
}

}  // namespace

rhi::BufferHandle make_buffer(rhi::Device& device, const Job& job, std::size_t index,
                              std::span<const std::byte> bytes) {
  return rhi::create_filled(device, bytes, usage_of(job, index), job.buffers[index].name);
}

Resources make_resources(rhi::Device& device, const Job& job) {
  Resources resources;
  for (std::size_t i = 0; i < job.buffers.size(); ++i)
    resources.buffers.push_back(make_buffer(device, job, i, job.buffers[i].initial));
  for (const Image& image : job.images) resources.images.push_back(make_image(device, image));
  for (const rhi::SamplerDesc& sampler : job.samplers) resources.samplers.push_back(device.create_sampler(sampler));
  for (const BottomLevel& level : job.bottom_levels)
    resources.bottom_levels.push_back(make_bottom_level(device, level));
  for (const TopLevel& level : job.top_levels) resources.top_levels.push_back(make_top_level(device, resources, level));
  return resources;
}

}  // namespace tandem::program
