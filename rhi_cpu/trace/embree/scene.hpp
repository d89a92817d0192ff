#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "rhi/acceleration_structure.hpp"
#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/trace/embree/embree.hpp"
#include "rhi_cpu/trace/embree/embree_device.hpp"
#include "rhi_cpu/trace/geometry_input.hpp"

/// What BottomLevel and TopLevel own, as the trace functions see it.
namespace tandem::cpu {

/// The quality of geometries that `flags` ask for: RTC_BUILD_QUALITY_REFIT when they will be moved. None splits
/// primitives, which would offer them twice.
RTCBuildQuality quality_of(rhi::BuildFlags flags);

/// An empty scene for geometries of a quality.
ScenePointer new_scene(const EmbreeDevice& device, RTCBuildQuality quality, std::string_view label);

struct GeometryCounts {
  std::size_t primitives = 0;
  std::size_t positions = 0;  ///< of triangles
};

struct BottomLevelScene {
  ScenePointer scene;
  std::vector<rhi::GeometryFlags> flags;          ///< of each geometry
  std::vector<GeometryCounts> counts;             ///< of each geometry
  std::vector<std::unique_ptr<BoxSet>> box_sets;  ///< of each geometry, where Embree's callbacks find them
  bool holds_boxes = false;                       ///< it holds boxes only, else triangles only
  bool all_opaque = true;
  RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;
  std::uint64_t bytes = 0;  ///< of the whole, Embree's memory included
};

/// What tracing needs of an instance beyond kernel::Instance.
struct InstanceTraits {
  std::shared_ptr<const BottomLevelScene> bottom_level;  ///< null: inactive
  rhi::InstanceFlags flags = rhi::InstanceFlags::none;
  std::uint32_t mask = 0;
};

/// The instances that hold primitives of one kind.
struct TracedScene {
  RTCScene scene = nullptr;  ///< what rays are traced in: owned_scene, or the one bottom level that makes up the scene
  ScenePointer owned_scene;
  /// `scene` is a bottom level, whose object space is world space; its instance is `direct_instance`.
  bool direct = false;
  std::uint32_t direct_instance = 0;
};

/// Triangles and boxes are traced apart, so that rays which look for triangles only never meet a box.
struct TopLevelScene : kernel::TopLevel {
  TracedScene triangles;
  TracedScene boxes;  ///< without a scene when has_boxes is false
  std::vector<kernel::Instance> instance_storage;
  std::vector<InstanceTraits> traits;  ///< one for each of instance_storage
  /// Rays with larger coordinates are not given to Embree, which stops the program for coordinates beyond its range.
  float coordinate_limit = 0;
  bool masks_in_filter = false;  ///< Embree does not skip instances by mask
  std::uint64_t bytes = 0;
};

/// The functions behind TopLevelScene.
extern const kernel::TraceFunctions embree_trace_functions;

/// The callback of user geometries, whose user pointer is their BoxSet: offers a box to the candidates' context.
void meet_box(const RTCIntersectFunctionNArguments* arguments);

}  // namespace tandem::cpu
