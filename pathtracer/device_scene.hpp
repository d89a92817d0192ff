#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pathtracer/scene.hpp"
#include "rhi/device.hpp"

namespace tandem::pathtracer {

/// The scene with its transparent triangles after the others: the triangles as devices number them.
Scene in_device_order(const Scene& scene);

/// A scene in a device's memory: what set 0 of shaders/scene.glsl binds.
class DeviceScene {
 public:
  /// Uploads the scene; its acceleration structures are still to be built. Throws rhi::Error for what the device
  /// refuses (a scene that is too large).
  DeviceScene(rhi::Device& device, const Scene& scene);

  /// Builds the acceleration structures; to be called once, before the first ray, and lets go of what only that needs.
  void record_build(rhi::CommandList& list);
  /// For a bind group of set 0 of a PathTraceProgram with the scene's transparency(): what it uses of the scene.
  std::vector<rhi::BindGroupEntry> entries(const rhi::PipelineInterface& interface) const;

  std::uint32_t triangle_count() const noexcept { return triangle_count_; }
  /// Those before the transparent ones, which come last on the device.
  std::uint32_t opaque_count() const noexcept { return opaque_count_; }
  bool transparency() const noexcept { return opaque_count_ < triangle_count_; }
  std::uint32_t light_count() const noexcept { return light_count_; }

 private:
  void upload(rhi::Device& device, const Scene& scene);
  void create_structures(rhi::Device& device, rhi::CommandList& list, const Scene& scene);

  std::uint32_t triangle_count_ = 0;
  std::uint32_t opaque_count_ = 0;
  std::uint32_t light_count_ = 0;
  rhi::BufferHandle positions_, normals_, triangles_, materials_, lights_;
  rhi::BufferHandle texture_coordinates_, alpha_textures_, alpha_texels_;  ///< null without transparency
  rhi::BottomLevelDesc bottom_;
  rhi::TopLevelDesc top_;
  rhi::AccelerationStructureHandle bottom_level_, top_level_;
};

}  // namespace tandem::pathtracer
