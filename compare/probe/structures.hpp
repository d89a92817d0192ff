#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "compare/probe/instance_setup.hpp"
#include "pathtracer/scene/scene.hpp"
#include "rhi/device.hpp"

namespace tandem::compare {

/// The scene's acceleration structures on a device, in every instance_setup. Even triangles and spheres are the
/// primitives of an opaque geometry 0, odd ones those of a geometry 1 that is not opaque. Spheres stand where they are
/// when the shutter opens.
class ProbeStructures {
 public:
  /// Uploads the scene. The device must outlive this.
  ProbeStructures(rhi::Device& device, const pathtracer::Scene& scene);

  /// Built at the first call.
  const rhi::AccelerationStructureHandle& top_level(InstanceSetup instance_setup);
  /// Centre and radius of each sphere; of one that does not exist where there are none, since no buffer is empty.
  const rhi::BufferHandle& spheres() const noexcept { return spheres_; }

 private:
  struct Built {
    std::vector<rhi::AccelerationStructureHandle> bottom_levels;  ///< kept alive
    rhi::AccelerationStructureHandle top_level;
  };

  rhi::BottomLevelDesc triangles(const rhi::BufferHandle& positions, bool indexed, const rhi::BufferHandle& transform,
                                 rhi::BuildFlags flags) const;
  rhi::BottomLevelDesc spheres(const rhi::BufferHandle& boxes, rhi::BuildFlags flags) const;
  std::vector<rhi::AccelerationStructureHandle> bottom_levels(InstanceSetup instance_setup) const;
  Built build(InstanceSetup instance_setup);

  rhi::Device& device_;
  const pathtracer::Scene& scene_;
  rhi::BufferHandle positions_, indices_, soup_, boxes_, spheres_;
  std::vector<rhi::AccelerationStructureHandle> plain_;  ///< of triangles, then of spheres, where there are any
  std::map<InstanceSetup, Built> built_;
};

}  // namespace tandem::compare
