#include "rhi_vulkan/acceleration_structure.hpp"

#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include "rhi/validation/built.hpp"
#include "rhi_vulkan/command_buffer.hpp"

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

AccelerationStructure::AccelerationStructure(ContextHandle context, const rhi::BottomLevelDesc& desc)
    : rhi::AccelerationStructure(Level::bottom, desc.label),
      context_(std::move(context)),
      type_(vk::AccelerationStructureTypeKHR::eBottomLevel),
      bottom_level_desc_(without_inputs(desc)) {
  create(build_input(desc, context_, desc.label));
}

AccelerationStructure::AccelerationStructure(ContextHandle context, const rhi::TopLevelDesc& desc)
    : rhi::AccelerationStructure(Level::top, desc.label),
      context_(std::move(context)),
      type_(vk::AccelerationStructureTypeKHR::eTopLevel) {
  top_level_desc_.instance_count = desc.instance_count;
  top_level_desc_.flags = desc.flags;
  create(build_input(desc, context_, desc.label));
}

AccelerationStructure::AccelerationStructure(const AccelerationStructure& source, std::uint64_t size, std::string label)
    : rhi::AccelerationStructure(source.level(), std::move(label)),
      context_(source.context_),
      type_(source.type_),
      bottom_level_desc_(source.bottom_level_desc_),
      top_level_desc_(source.top_level_desc_),
      is_compacted_(true),
      sizes_(source.sizes_),
      built_instance_count_(source.built_instance_count_.load()) {
  allocate(size);
}

rhi::BuildFlags AccelerationStructure::flags() const noexcept {
  return level() == Level::bottom ? bottom_level_desc_.flags : top_level_desc_.flags;
}

std::optional<std::uint32_t> AccelerationStructure::built_instance_count() const noexcept {
  const std::int64_t count = built_instance_count_;
  if (count == never_built) return std::nullopt;
  return static_cast<std::uint32_t>(count);
}

void AccelerationStructure::create(const BuildInput& input) {
  std::vector<std::uint32_t> primitive_counts;
  for (const vk::AccelerationStructureBuildRangeInfoKHR& range : input.ranges)
    primitive_counts.push_back(range.primitiveCount);
  const vk::AccelerationStructureBuildSizesInfoKHR sizes = context_->device.getAccelerationStructureBuildSizesKHR(
      vk::AccelerationStructureBuildTypeKHR::eDevice, input.info(), primitive_counts);
  sizes_.build_scratch = sizes.buildScratchSize;
  if (has(flags(), rhi::BuildFlags::allow_update)) sizes_.update_scratch = sizes.updateScratchSize;
  allocate(sizes.accelerationStructureSize);
}

void AccelerationStructure::allocate(std::uint64_t size) {
  using Usage = vk::BufferUsageFlagBits;
  translating_errors(label(), "create the acceleration structure", [&] {
    sizes_.structure = size;
    buffer_ = make_backed_buffer(*context_, size, Usage::eAccelerationStructureStorageKHR | Usage::eShaderDeviceAddress,
                                 MemoryKind::device, label());
    structure_ =
        context_->device.createAccelerationStructureKHR({.buffer = *buffer_.handle, .size = size, .type = type_});
    context_->name(structure_, label());
    address_ = context_->device.getAccelerationStructureAddressKHR({.accelerationStructure = *structure_});
  });
}

rhi::AccelerationStructureHandle make_compacted(const rhi::AccelerationStructureHandle& handle,
                                                const AccelerationStructure& source, const std::string& label) {
  Context& context = *source.context();
  rhi::validation::check_compacted(source, source.built_instance_count().has_value(), label);
  return translating_errors(label, "compact the acceleration structure", [&] {
    struct InFlight {
      rhi::AccelerationStructureHandle source;
      vk::raii::QueryPool pool;
    };
    const auto in_flight = std::make_shared<InFlight>(
        InFlight{handle, context.device.createQueryPool(
                             {.queryType = vk::QueryType::eAccelerationStructureCompactedSizeKHR, .queryCount = 1})});
    const vk::QueryPool pool = *in_flight->pool;
    context.queue.wait(submit_commands(context, label, in_flight, [&](const vk::raii::CommandBuffer& commands) {
      commands.resetQueryPool(pool, 0, 1);
      commands.writeAccelerationStructuresPropertiesKHR(source.handle(),
                                                        vk::QueryType::eAccelerationStructureCompactedSizeKHR, pool, 0);
    }));
    const std::uint64_t size =
        in_flight->pool.getResult<std::uint64_t>(0, 1, sizeof(std::uint64_t), vk::QueryResultFlagBits::e64).second;

    auto copy = std::make_shared<AccelerationStructure>(source, size, label);
    const auto both =
        std::make_shared<std::pair<rhi::AccelerationStructureHandle, rhi::AccelerationStructureHandle>>(handle, copy);
    context.queue.wait(submit_commands(context, label, both, [&](const vk::raii::CommandBuffer& commands) {
      commands.copyAccelerationStructureKHR(
          {.src = source.handle(), .dst = copy->handle(), .mode = vk::CopyAccelerationStructureModeKHR::eCompact});
    }));
    return copy;
  });
}

}  // namespace tandem::vulkan
