#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rhi/acceleration_structure.hpp"
#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/trace/embree.hpp"

/// What BottomLevel and TopLevel own, as the trace functions see it.
namespace tandem::cpu {

struct BottomLevelScene {
  ScenePointer scene;
  std::vector<rhi::GeometryFlags> flags;  ///< of each geometry
  bool all_opaque = true;
};

/// What tracing needs of an instance beyond kernel::Instance.
struct InstanceTraits {
  std::shared_ptr<const BottomLevelScene> bottom_level;  ///< null: inactive
  rhi::InstanceFlags flags = rhi::InstanceFlags::none;
  std::uint32_t mask = 0;
};

struct TopLevelScene : kernel::TopLevel {
  RTCScene scene = nullptr;  ///< what rays are traced in: owned_scene, or the one bottom level that makes up the scene
  ScenePointer owned_scene;
  std::vector<kernel::Instance> instance_storage;
  std::vector<InstanceTraits> traits;  ///< one for each of instance_storage
  /// `scene` is a bottom level, whose object space is world space; its instance is `direct_instance`.
  bool direct = false;
  std::uint32_t direct_instance = 0;
  /// Rays with larger coordinates are not given to Embree, which stops the program for coordinates beyond its range.
  float coordinate_limit = 0;
  bool masks_in_filter = false;  ///< Embree does not skip instances by mask
};

/// The functions behind TopLevelScene.
extern const kernel::TraceFunctions embree_trace_functions;

}  // namespace tandem::cpu
