#include "rhi_cpu/command_list.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "rhi/error.hpp"
#include "rhi/validation.hpp"
#include "rhi/validation/built.hpp"
#include "rhi_cpu/acceleration_structure.hpp"
#include "rhi_cpu/bind_group.hpp"
#include "rhi_cpu/buffer.hpp"
#include "rhi_cpu/compute_pipeline.hpp"
#include "rhi_cpu/launch/launch_fibres.hpp"
#include "rhi_cpu/launch/launch_watch.hpp"
#include "rhi_cpu/query_pool.hpp"
#include "rhi_cpu/ray_launch.hpp"
#include "rhi_cpu/shader_table.hpp"
#include "rhi_cpu/texture.hpp"

namespace tandem::cpu {
namespace {

std::shared_ptr<Buffer> own_buffer(const rhi::BufferHandle& buffer, const DeviceState& device) {
  return own<Buffer>(buffer, device, buffer->desc().label);
}

std::vector<std::shared_ptr<BindGroup>> own_groups(std::span<const rhi::BindGroupHandle> groups,
                                                   const DeviceState& device, const std::string& label) {
  std::vector<std::shared_ptr<BindGroup>> result;
  for (const rhi::BindGroupHandle& group : groups) result.push_back(own<BindGroup>(group, device, label));
  return result;
}

/// What the structure was created from; a desc without anything when it is none of ours, which own() refuses later.
template <typename Structure>
auto created_from(const rhi::AccelerationStructureHandle& structure) {
  const auto created = std::dynamic_pointer_cast<Structure>(structure);
  return created != nullptr ? created->created_from() : std::remove_cvref_t<decltype(created->created_from())>{};
}

template <typename Structure>
std::shared_ptr<Structure> own_buildable(const rhi::AccelerationStructureHandle& structure, const DeviceState& device) {
  std::shared_ptr<Structure> built = own<Structure>(structure, device, structure->label());
  rhi::validation::check_room(*built, built->is_compacted());
  return built;
}

using Size = std::array<std::uint32_t, 3>;

void run(const ComputePipeline& pipeline, std::span<const std::shared_ptr<BindGroup>> groups,
         std::span<const std::byte> push_constants, const Size& workgroup_count, const Size& base,
         DeviceState& device) {
  const kernel::KernelInfo& kernel = pipeline.kernel();
  const ResourceTable table = resource_table(kernel, groups, pipeline.label());
  const LaunchWatch watch(device.time_limit, pipeline.label());
  const kernel::Dispatch dispatch{.resources = table.resources.data(),
                                  .push_constants = push_constants.data(),
                                  .workgroup_count = {workgroup_count[0], workgroup_count[1], workgroup_count[2]},
                                  .base_workgroup = {base[0], base[1], base[2]},
                                  .watch = watch.watch()};
  const std::uint64_t count = std::uint64_t{workgroup_count[0]} * workgroup_count[1] * workgroup_count[2];
  device.workers.for_each_range(count, [&](std::uint64_t first, std::uint64_t end) {
    watch.look();
    const LaunchFibres fibres(device.fibres, pipeline.label());
    kernel::Dispatch range = dispatch;
    range.fibres = fibres.host();
    kernel.run(range, first, end);
  });
}

Size read_size(const Buffer& buffer, std::uint64_t offset) {
  Size size;
  std::memcpy(size.data(), buffer.data() + offset, sizeof(size));
  return size;
}

/// The count that a shader or an upload left in the buffer. Throws Error where it is beyond the device's limit.
Size indirect_count(const Buffer& buffer, std::uint64_t offset, const rhi::Limits& limits, const std::string& label) {
  const Size count = read_size(buffer, offset);
  for (std::size_t i = 0; i < 3; ++i)
    if (count[i] > limits.max_workgroup_count[i])
      throw rhi::Error(rhi::ErrorCode::invalid_argument, label,
                       fmt::format("an indirect dispatch of {} workgroups in dimension {}, of which the device has {}",
                                   count[i], i, limits.max_workgroup_count[i]));
  return count;
}

/// Likewise, of a trace.
Size indirect_size(const Buffer& buffer, std::uint64_t offset, const rhi::Limits& limits, const std::string& label) {
  const Size size = read_size(buffer, offset);
  std::uint64_t rest = limits.max_ray_invocations;
  for (const std::uint32_t side : size) {
    if (side == 0) return {0, 0, 0};
    rest /= side;
  }
  if (rest == 0)
    throw rhi::Error(rhi::ErrorCode::invalid_argument, label,
                     fmt::format("an indirect trace of {} x {} x {} has more than the device's {} invocations", size[0],
                                 size[1], size[2], limits.max_ray_invocations));
  return size;
}

}  // namespace

CommandList::CommandList(DeviceStateHandle device, std::string label)
    : rhi::CommandList(std::move(label)), device_(std::move(device)) {}

void CommandList::record(std::function<void()> command) {
  if (submitted_)
    throw rhi::Error(rhi::ErrorCode::invalid_argument, label(), "a command is recorded after the list was submitted");
  commands_.push_back(std::move(command));
}

void CommandList::upload(const rhi::BufferHandle& buffer, std::uint64_t offset, std::span<const std::byte> bytes) {
  rhi::validation::check_upload(*this, buffer, offset, bytes.size());
  record(
      [destination = own_buffer(buffer, *device_), offset, copy = std::vector<std::byte>(bytes.begin(), bytes.end())] {
        std::copy(copy.begin(), copy.end(), destination->data() + offset);
      });
}

void CommandList::copy(const rhi::BufferRange& source, const rhi::BufferRange& destination) {
  rhi::validation::check_copy(*this, source, destination);
  record([from = own_buffer(source.buffer, *device_), from_offset = source.offset,
          to = own_buffer(destination.buffer, *device_), to_offset = destination.offset,
          size = source.resolved_size()] {
    std::memcpy(to->data() + to_offset, from->data() + from_offset, static_cast<std::size_t>(size));
  });
}

void CommandList::fill(const rhi::BufferRange& range, std::uint32_t value) {
  rhi::validation::check_fill(*this, range);
  record([buffer = own_buffer(range.buffer, *device_), offset = range.offset, size = range.resolved_size(), value] {
    for (std::uint64_t i = 0; i < size; i += sizeof(value))
      std::memcpy(buffer->data() + offset + i, &value, sizeof(value));
  });
}

void CommandList::copy_to_texture(const rhi::BufferRange& source, const rhi::TextureHandle& destination) {
  rhi::validation::check_texture_copy(*this, source, destination);
  record([from = own_buffer(source.buffer, *device_), offset = source.offset,
          to = own<Texture>(destination, *device_, destination->desc().label)] {
    std::copy_n(from->data() + offset, to->texels().size(), to->texels().data());
  });
}

void CommandList::copy_from_texture(const rhi::TextureHandle& source, const rhi::BufferRange& destination) {
  rhi::validation::check_texture_copy(*this, destination, source);
  record([from = own<Texture>(source, *device_, source->desc().label), to = own_buffer(destination.buffer, *device_),
          offset = destination.offset] {
    std::copy_n(from->texels().data(), from->texels().size(), to->data() + offset);
  });
}

void CommandList::build_bottom_level(const rhi::AccelerationStructureHandle& structure,
                                     const rhi::BottomLevelDesc& desc) {
  rhi::validation::check(desc, device_->info);
  rhi::validation::check_build(*this, structure, created_from<BottomLevelStructure>(structure), desc);
  check_owner(desc, *device_);
  record([built = own_buildable<BottomLevelStructure>(structure, *device_), desc] { built->build(desc); });
}

void CommandList::build_top_level(const rhi::AccelerationStructureHandle& structure, const rhi::TopLevelDesc& desc) {
  rhi::validation::check(desc, device_->info);
  rhi::validation::check_build(*this, structure, created_from<TopLevelStructure>(structure), desc);
  check_owner(desc, *device_);
  record([built = own_buildable<TopLevelStructure>(structure, *device_), desc] { built->build(desc); });
}

void CommandList::update_bottom_level(const rhi::AccelerationStructureHandle& structure,
                                      const rhi::BottomLevelDesc& desc) {
  rhi::validation::check(desc, device_->info);
  rhi::validation::check_update(*this, structure, created_from<BottomLevelStructure>(structure), desc);
  check_owner(desc, *device_);
  record([built = own<BottomLevelStructure>(structure, *device_, structure->label()), desc] { built->update(desc); });
}

void CommandList::update_top_level(const rhi::AccelerationStructureHandle& structure, const rhi::TopLevelDesc& desc) {
  rhi::validation::check(desc, device_->info);
  rhi::validation::check_update(*this, structure, created_from<TopLevelStructure>(structure), desc);
  check_owner(desc, *device_);
  record([built = own<TopLevelStructure>(structure, *device_, structure->label()), desc] { built->update(desc); });
}

void CommandList::dispatch(const rhi::DispatchDesc& desc) {
  rhi::validation::check(desc, device_->info);
  const std::string& label = desc.pipeline->label();
  std::shared_ptr<Buffer> indirect;
  if (!desc.indirect_count.empty()) indirect = own_buffer(desc.indirect_count.buffer, *device_);
  record([pipeline = own<ComputePipeline>(desc.pipeline, *device_, label),
          groups = own_groups(desc.bind_groups, *device_, label),
          push_constants = std::vector<std::byte>(desc.push_constants.begin(), desc.push_constants.end()),
          count = desc.workgroup_count, base = desc.base_workgroup, indirect, offset = desc.indirect_count.offset,
          device = device_] {
    const Size dispatched =
        indirect == nullptr ? count : indirect_count(*indirect, offset, device->info.limits, pipeline->label());
    run(*pipeline, groups, push_constants, dispatched, base, *device);
  });
}

void CommandList::trace_rays(const rhi::TraceRaysDesc& desc) {
  rhi::validation::check(desc, device_->info);
  const std::string& label = desc.table->desc().pipeline->label();
  std::shared_ptr<Buffer> indirect;
  if (!desc.indirect_size.empty()) indirect = own_buffer(desc.indirect_size.buffer, *device_);
  record([table = own<ShaderTable>(desc.table, *device_, desc.table->label()),
          first = FirstRecords{.ray_generation = desc.ray_generation_record,
                               .miss = desc.first_miss_record,
                               .hit = desc.first_hit_record,
                               .callable = desc.first_callable_record},
          groups = own_groups(desc.bind_groups, *device_, label),
          push_constants = std::vector<std::byte>(desc.push_constants.begin(), desc.push_constants.end()),
          size = desc.size, indirect, offset = desc.indirect_size.offset, device = device_] {
    const Size launched =
        indirect == nullptr ? size : indirect_size(*indirect, offset, device->info.limits, table->pipeline().label());
    cpu::trace_rays(*table, first, groups, push_constants, launched, *device);
  });
}

void CommandList::write_timestamp(const rhi::QueryPoolHandle& pool, std::uint32_t index) {
  rhi::validation::check_timestamp(*this, pool, index);
  record([own_pool = own<QueryPool>(pool, *device_, pool->desc().label), index] { own_pool->write(index); });
}

void CommandList::execute() {
  submitted_ = true;
  for (const std::function<void()>& command : commands_) command();
}

}  // namespace tandem::cpu
