#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rhi/acceleration_structure.hpp"
#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/trace/exact/bvh.hpp"
#include "rhi_cpu/trace/exact/transform.hpp"
#include "rhi_cpu/trace/geometry_input.hpp"

/// What BottomLevel and TopLevel own, as the trace functions see it.
namespace tandem::cpu::exact {

struct PrimitiveId {
  std::uint32_t geometry;
  std::uint32_t primitive;
};

struct BottomLevelScene {
  std::vector<GeometryMesh> geometries;
  std::vector<PrimitiveId> primitives;  ///< the active ones: the items of `bvh`
  Bvh bvh;
  bool all_opaque = true;  ///< every triangle's geometry is
  bool has_boxes = false;
};

/// What tracing needs of an instance beyond kernel::Instance.
struct InstanceTraits {
  std::shared_ptr<const BottomLevelScene> bottom_level;  ///< null: inactive
  Transform transform = {};
  rhi::InstanceFlags flags = rhi::InstanceFlags::none;
  std::uint32_t mask = 0;
};

struct TopLevelScene : kernel::TopLevel {
  std::vector<kernel::Instance> instance_storage;
  std::vector<InstanceTraits> traits;           ///< one for each of instance_storage
  std::vector<std::uint32_t> active_instances;  ///< the items of `bvh`
  Bvh bvh;
};

/// The functions behind TopLevelScene.
extern const kernel::TraceFunctions exact_trace_functions;

}  // namespace tandem::cpu::exact
