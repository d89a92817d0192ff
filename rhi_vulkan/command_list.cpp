#include "rhi_vulkan/command_list.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "rhi/validation.hpp"
#include "rhi/validation/built.hpp"
#include "rhi_vulkan/bind_group.hpp"
#include "rhi_vulkan/compute_pipeline.hpp"
#include "rhi_vulkan/ray_tracing_pipeline.hpp"
#include "rhi_vulkan/shader_table.hpp"

namespace tandem::vulkan {
namespace {

/// Uploads go in pieces of this size, so that staging never needs one allocation as large as the buffer.
constexpr std::uint64_t upload_piece = 32ull << 20;
constexpr std::uint64_t staging_alignment = 16;
/// Builds run side by side until their scratch memory reaches this; then a barrier lets it be used again.
constexpr std::uint64_t most_scratch = 256ull << 20;

Access access(const rhi::BufferRange& range, bool writes) {
  return {range.buffer.get(), range.offset, range.offset + range.resolved_size(), writes};
}

}  // namespace

CommandList::Recording::Recording(CommandBuffer command_buffer)
    : commands(std::move(command_buffer)),
      staging(vk::BufferUsageFlagBits::eTransferSrc, MemoryKind::upload, "upload staging"),
      scratch(vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eShaderDeviceAddress,
              MemoryKind::device, "build scratch") {}

CommandList::CommandList(ContextHandle context, std::string label)
    : rhi::CommandList(std::move(label)),
      context_(std::move(context)),
      recording_(std::make_shared<Recording>(begin_command_buffer(*context_, this->label()))) {}

CommandList::Recording& CommandList::recording() {
  if (recording_->ended)
    throw rhi::Error(rhi::ErrorCode::invalid_argument, label(), "a command is recorded after the list was submitted");
  return *recording_;
}

void CommandList::order(CommandKind kind, std::span<const Access> accesses) {
  if (!dependencies_.needs_barrier(kind, accesses)) return;
  full_barrier(recording_->commands.handle);
  recording_->scratch.reuse();
}

void CommandList::upload(const rhi::BufferHandle& buffer, std::uint64_t offset, std::span<const std::byte> bytes) {
  Recording& recording = this->recording();
  rhi::validation::check_upload(*this, buffer, offset, bytes.size());
  const Buffer& target = own<Buffer>(buffer, context_, label(), "buffer of an upload");
  if (bytes.empty()) return;
  recording.resources.push_back(buffer);
  order(CommandKind::transfer, std::array{access({buffer, offset, bytes.size()}, true)});
  while (!bytes.empty()) {
    const std::uint64_t size = std::min<std::uint64_t>(bytes.size(), upload_piece);
    const TransientMemory::Piece piece = recording.staging.allocate(*context_, size, staging_alignment);
    std::memcpy(piece.mapped, bytes.data(), size);
    recording.commands.handle.copyBuffer(piece.buffer, target.handle(),
                                         vk::BufferCopy{.srcOffset = piece.offset, .dstOffset = offset, .size = size});
    bytes = bytes.subspan(size);
    offset += size;
  }
}

void CommandList::copy(const rhi::BufferRange& source, const rhi::BufferRange& destination) {
  Recording& recording = this->recording();
  rhi::validation::check_copy(*this, source, destination);
  const Buffer& from = own<Buffer>(source.buffer, context_, label(), "source of a copy");
  const Buffer& to = own<Buffer>(destination.buffer, context_, label(), "destination of a copy");
  recording.resources.push_back(source.buffer);
  recording.resources.push_back(destination.buffer);
  order(CommandKind::transfer, std::array{access(source, false), access(destination, true)});
  recording.commands.handle.copyBuffer(
      from.handle(), to.handle(),
      vk::BufferCopy{.srcOffset = source.offset, .dstOffset = destination.offset, .size = source.resolved_size()});
}

void CommandList::fill(const rhi::BufferRange& range, std::uint32_t value) {
  Recording& recording = this->recording();
  rhi::validation::check_fill(*this, range);
  const Buffer& target = own<Buffer>(range.buffer, context_, label(), "buffer of a fill");
  recording.resources.push_back(range.buffer);
  order(CommandKind::transfer, std::array{access(range, true)});
  recording.commands.handle.fillBuffer(target.handle(), range.offset, range.resolved_size(), value);
}

void CommandList::copy_to_texture(const rhi::BufferRange& source, const rhi::TextureHandle& destination) {
  constexpr vk::ImageLayout layout = vk::ImageLayout::eTransferDstOptimal;
  copy_texture(source, destination, layout, [&](const Buffer& buffer, const Texture& texture) {
    recording_->commands.handle.copyBufferToImage(buffer.handle(), texture.handle(), layout,
                                                  texture.whole(source.offset));
  });
}

void CommandList::copy_from_texture(const rhi::TextureHandle& source, const rhi::BufferRange& destination) {
  constexpr vk::ImageLayout layout = vk::ImageLayout::eTransferSrcOptimal;
  copy_texture(destination, source, layout, [&](const Buffer& buffer, const Texture& texture) {
    recording_->commands.handle.copyImageToBuffer(texture.handle(), layout, buffer.handle(),
                                                  texture.whole(destination.offset));
  });
}

template <typename Copy>
void CommandList::copy_texture(const rhi::BufferRange& range, const rhi::TextureHandle& handle, vk::ImageLayout layout,
                               Copy&& copy) {
  Recording& recording = this->recording();
  rhi::validation::check_texture_copy(*this, range, handle);
  const Buffer& buffer = own<Buffer>(range.buffer, context_, label(), "buffer of a texture's copy");
  const Texture& texture = own<Texture>(handle, context_, label(), "texture of a copy");
  recording.resources.push_back(range.buffer);
  recording.resources.push_back(handle);
  // Changing the layout orders the copy behind everything before and in front of everything after.
  order(CommandKind::exclusive, {});
  texture.change_layout(recording.commands.handle, vk::ImageLayout::eGeneral, layout);
  copy(buffer, texture);
  texture.change_layout(recording.commands.handle, layout, vk::ImageLayout::eGeneral);
}

void CommandList::build_bottom_level(const rhi::AccelerationStructureHandle& structure,
                                     const rhi::BottomLevelDesc& desc) {
  build(structure, desc, vk::BuildAccelerationStructureModeKHR::eBuild);
}

void CommandList::update_bottom_level(const rhi::AccelerationStructureHandle& structure,
                                      const rhi::BottomLevelDesc& desc) {
  build(structure, desc, vk::BuildAccelerationStructureModeKHR::eUpdate);
}

void CommandList::build_top_level(const rhi::AccelerationStructureHandle& structure, const rhi::TopLevelDesc& desc) {
  build(structure, desc, vk::BuildAccelerationStructureModeKHR::eBuild);
}

void CommandList::update_top_level(const rhi::AccelerationStructureHandle& structure, const rhi::TopLevelDesc& desc) {
  build(structure, desc, vk::BuildAccelerationStructureModeKHR::eUpdate);
}

template <typename Desc>
void CommandList::build(const rhi::AccelerationStructureHandle& handle, const Desc& desc,
                        vk::BuildAccelerationStructureModeKHR mode) {
  constexpr bool is_bottom_level = std::is_same_v<Desc, rhi::BottomLevelDesc>;
  const bool updates = mode == vk::BuildAccelerationStructureModeKHR::eUpdate;
  const auto check_against = [&](const Desc& created_from) {
    if (updates)
      rhi::validation::check_update(*this, handle, created_from, desc);
    else
      rhi::validation::check_build(*this, handle, created_from, desc);
  };
  Recording& recording = this->recording();
  rhi::validation::check(desc, context_->physical.info);
  if (handle == nullptr) check_against(Desc());
  auto& structure = own<AccelerationStructure>(handle, context_, label(), "acceleration structure");
  if constexpr (is_bottom_level)
    check_against(structure.bottom_level_desc());
  else
    check_against(structure.top_level_desc());
  if (!updates) rhi::validation::check_room(structure, structure.is_compacted());

  const BuildInput input = build_input(desc, context_, structure.label());
  const std::uint64_t scratch_size =
      std::max<std::uint64_t>(updates ? structure.sizes().update_scratch : structure.sizes().build_scratch, 1);
  if (recording.scratch.used() + scratch_size > most_scratch) dependencies_.require_barrier();
  // A top level refers to bottom levels by address, so nobody knows what it touches.
  order(is_bottom_level ? CommandKind::bottom_level_build : CommandKind::exclusive,
        std::array{Access{&structure, 0, 1, true}});
  const TransientMemory::Piece scratch =
      recording.scratch.allocate(*context_, scratch_size, context_->physical.scratch_alignment);
  recording.resources.push_back(handle);
  recording.resources.insert(recording.resources.end(), input.buffers.begin(), input.buffers.end());
  vk::AccelerationStructureBuildGeometryInfoKHR info = input.info();
  info.mode = mode;
  if (updates) info.srcAccelerationStructure = structure.handle();
  info.dstAccelerationStructure = structure.handle();
  info.scratchData.deviceAddress = scratch.device_address;
  const vk::AccelerationStructureBuildRangeInfoKHR* const ranges = input.ranges.data();
  recording.commands.handle.buildAccelerationStructuresKHR(info, ranges);
  std::uint32_t instance_count = 0;
  if constexpr (!is_bottom_level) instance_count = desc.instance_count;
  structure_uses_.push_back({.kind = updates ? StructureUse::Kind::update : StructureUse::Kind::build,
                             .structure = std::static_pointer_cast<AccelerationStructure>(handle),
                             .instance_count = instance_count,
                             .pipeline = {}});
}

void CommandList::bind(vk::PipelineBindPoint point, vk::Pipeline pipeline, const PipelineLayout& layout,
                       const std::string& label, std::span<const rhi::BindGroupHandle> bind_groups,
                       std::span<const std::byte> push_constants) {
  const vk::raii::CommandBuffer& commands = recording_->commands.handle;
  commands.bindPipeline(point, pipeline);
  for (const rhi::BindGroupHandle& group : bind_groups) {
    const std::uint32_t set = group->desc().set;
    if (!layout.uses_set(set)) continue;
    note_traced(*group, label);
    const vk::DescriptorSet handle = own<BindGroup>(group, context_, this->label(), "bind group").handle();
    commands.bindDescriptorSets(point, layout.handle(), set, handle, nullptr);
  }
  if (!push_constants.empty())
    commands.pushConstants<std::byte>(layout.handle(), context_->physical.shader_stages, 0,
                                      {static_cast<std::uint32_t>(push_constants.size()), push_constants.data()});
  recording_->resources.insert(recording_->resources.end(), bind_groups.begin(), bind_groups.end());
}

void CommandList::dispatch(const rhi::DispatchDesc& desc) {
  Recording& recording = this->recording();
  rhi::validation::check(desc, context_->physical.info);
  const auto& pipeline = own<ComputePipeline>(desc.pipeline, context_, label(), "pipeline");
  recording.resources.push_back(desc.pipeline);
  const Buffer* indirect = nullptr;
  if (!desc.indirect_count.empty()) {
    indirect = &own<Buffer>(desc.indirect_count.buffer, context_, label(), "buffer of an indirect count");
    recording.resources.push_back(desc.indirect_count.buffer);
  }
  order(CommandKind::exclusive, {});
  bind(vk::PipelineBindPoint::eCompute, pipeline.handle(), pipeline.layout(), pipeline.label(), desc.bind_groups,
       desc.push_constants);
  const vk::raii::CommandBuffer& commands = recording.commands.handle;
  const std::array<std::uint32_t, 3>& base = desc.base_workgroup;
  const std::array<std::uint32_t, 3>& count = desc.workgroup_count;
  if (indirect != nullptr)
    commands.dispatchIndirect(indirect->handle(), desc.indirect_count.offset);
  else
    commands.dispatchBase(base[0], base[1], base[2], count[0], count[1], count[2]);
}

void CommandList::trace_rays(const rhi::TraceRaysDesc& desc) {
  Recording& recording = this->recording();
  rhi::validation::check(desc, context_->physical.info);
  const auto& table = own<ShaderTable>(desc.table, context_, label(), "shader table");
  const bool is_indirect = !desc.indirect_size.empty();
  if (!is_indirect && std::find(desc.size.begin(), desc.size.end(), 0u) != desc.size.end()) return;
  std::uint64_t size_address = 0;
  if (is_indirect) {
    size_address = own<Buffer>(desc.indirect_size.buffer, context_, label(), "buffer of an indirect size").address() +
                   desc.indirect_size.offset;
    recording.resources.push_back(desc.indirect_size.buffer);
  }
  recording.resources.push_back(desc.table);
  order(CommandKind::exclusive, {});
  const RayTracingPipeline& pipeline = table.pipeline();
  bind(vk::PipelineBindPoint::eRayTracingKHR, pipeline.handle(), pipeline.layout(), pipeline.label(), desc.bind_groups,
       desc.push_constants);
  const vk::raii::CommandBuffer& commands = recording.commands.handle;
  if (pipeline.stack_size()) commands.setRayTracingPipelineStackSizeKHR(*pipeline.stack_size());
  const auto ray_generation = table.ray_generation(desc.ray_generation_record);
  const auto miss = table.records(GroupKind::miss, desc.first_miss_record);
  const auto hit = table.records(GroupKind::hit, desc.first_hit_record);
  const auto callable = table.records(GroupKind::callable, desc.first_callable_record);
  if (is_indirect)
    commands.traceRaysIndirectKHR(ray_generation, miss, hit, callable, size_address);
  else
    commands.traceRaysKHR(ray_generation, miss, hit, callable, desc.size[0], desc.size[1], desc.size[2]);
}

void CommandList::write_timestamp(const rhi::QueryPoolHandle& pool, std::uint32_t index) {
  Recording& recording = this->recording();
  rhi::validation::check_timestamp(*this, pool, index);
  const auto& queries = own<QueryPool>(pool, context_, label(), "query pool");
  recording.resources.push_back(pool);
  timestamps_.emplace_back(std::static_pointer_cast<QueryPool>(pool), index);
  recording.commands.handle.resetQueryPool(queries.handle(), index, 1);
  // The bottom of the pipe is reached when all commands before are done; the barrier keeps the next ones from
  // beginning.
  recording.commands.handle.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, queries.handle(), index);
  dependencies_.require_barrier();
}

void CommandList::note_traced(const rhi::BindGroup& group, const std::string& pipeline) {
  for (const rhi::BindGroupEntry& entry : group.desc().entries) {
    const auto* handle = std::get_if<rhi::AccelerationStructureHandle>(&entry.resource);
    if (handle == nullptr || *handle == nullptr) continue;
    structure_uses_.push_back({.kind = StructureUse::Kind::trace,
                               .structure = std::static_pointer_cast<AccelerationStructure>(*handle),
                               .instance_count = 0,
                               .pipeline = pipeline});
  }
}

std::map<AccelerationStructure*, std::uint32_t> CommandList::check_structure_uses() const {
  std::map<AccelerationStructure*, std::uint32_t> built;
  for (const StructureUse& use : structure_uses_) {
    AccelerationStructure& structure = *use.structure;
    const auto here = built.find(&structure);
    const std::optional<std::uint32_t> count =
        here != built.end() ? std::optional(here->second) : structure.built_instance_count();
    switch (use.kind) {
      case StructureUse::Kind::build:
        built[&structure] = use.instance_count;
        break;
      case StructureUse::Kind::update:
        rhi::validation::check_updated(structure, count, use.instance_count);
        break;
      case StructureUse::Kind::trace:
        rhi::validation::check_traced(structure, count.has_value(), use.pipeline);
        break;
    }
  }
  return built;
}

std::uint64_t CommandList::submit() {
  return translating_errors(label(), "submit the command list", [&] {
    if (!std::exchange(recording_->ended, true)) recording_->commands.handle.end();
    const auto built = check_structure_uses();
    const std::uint64_t number = context_->queue.submit(*recording_->commands.handle, recording_);
    for (const auto& [pool, index] : timestamps_) pool->mark_submitted(index);
    for (const auto& [structure, instance_count] : built) structure->mark_built(instance_count);
    return number;
  });
}

}  // namespace tandem::vulkan
