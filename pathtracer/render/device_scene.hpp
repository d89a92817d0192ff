#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pathtracer/render/features.hpp"
#include "pathtracer/scene/lights.hpp"
#include "pathtracer/scene/scene.hpp"
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

  /// Replaces the point, spot and directional lights of the scene. The caller must recreate bind groups that hold its
  /// entries; features() may have grown. Throws Error for numbers out of range and then changes nothing.
  void set_lights(rhi::Device& device, std::span<const PunctualLight> lights);

  /// Builds the acceleration structures and releases the inputs of the build. Call it once, before the first ray.
  void record_build(rhi::CommandList& list);
  /// For a bind group of set 0 of a PathTraceProgram: what it uses of the scene.
  /// @param constants a buffer of one RenderConstants
  std::vector<rhi::BindGroupEntry> entries(const rhi::PipelineInterface& interface,
                                           const rhi::BufferHandle& constants) const;
  /// Sets the members that describe the scene: counts, the environment and its light, the medium; and `shutter` where
  /// something moves.
  void describe(RenderConstants& constants) const;

  std::uint32_t triangle_count() const noexcept { return triangle_count_; }
  /// Those before the transparent ones, which come last on the device.
  std::uint32_t opaque_count() const noexcept { return opaque_count_; }
  /// What the shaders must be able to do for it.
  Features features() const noexcept { return features_; }
  std::uint32_t light_count() const noexcept { return light_count_; }
  /// Memory of the acceleration structures, in bytes; known once they are built.
  std::uint64_t structure_bytes() const;
  /// Of the scene.
  const std::optional<Environment>& environment() const noexcept { return environment_; }

 private:
  void upload(rhi::Device& device, const Scene& scene);
  void upload_lights(rhi::Device& device, rhi::CommandList& list, std::span<const Emitter> punctual);
  void create_structures(rhi::Device& device, rhi::CommandList& list, const Scene& scene);
  rhi::BottomLevelDesc describe_triangles(rhi::Device& device, rhi::CommandList& list, const Scene& scene) const;

  std::uint32_t triangle_count_ = 0;
  std::uint32_t opaque_count_ = 0;
  std::string name_;
  std::vector<Emitter> emitters_;  ///< the lights that stay
  double radius_ = 0;              ///< of the scene
  std::uint32_t light_count_ = 0;
  std::uint32_t environment_light_ = no_light;
  Features features_ = 0;
  std::optional<Environment> environment_;
  std::uint32_t medium_ = no_medium;
  bool moves_ = false;
  rhi::BufferHandle positions_, normals_, triangles_, materials_, lights_, texture_coordinates_, attributes_, textures_,
      texels_, primitive_lights_, spheres_, environment_cells_, media_;
  /// A bottom level and what to build it from, until it is built.
  struct BottomLevel {
    rhi::AccelerationStructureHandle structure;
    rhi::BottomLevelDesc desc;
  };
  std::vector<BottomLevel> bottom_levels_;  ///< of the triangles and of the spheres, where there are any
  rhi::TopLevelDesc top_;
  rhi::AccelerationStructureHandle top_level_;
};

}  // namespace tandem::pathtracer
