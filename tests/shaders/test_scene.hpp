#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "pathtracer/scene/scene.hpp"
#include "rhi/device.hpp"

namespace tandem::test {

/// A scene made by hand, and what the path tracer reads of it.
struct TestScene {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< of the positions; read for those of smooth triangles only
  std::vector<pathtracer::GpuTriangle> triangles;
  std::vector<pathtracer::GpuMaterial> materials;
  std::vector<pathtracer::GpuLight> lights;
  std::vector<pathtracer::GpuMedium> media;
  std::vector<pathtracer::GpuEnvironmentCell> environment_cells;

  /// A diffuse, black, not emissive material to start from. Returns its index.
  std::uint32_t add_material(const pathtracer::GpuMaterial& material);
  /// The parallelogram origin, origin + u, origin + u + v, origin + v; seen counter-clockwise from u x v.
  void add_quad(const glm::vec3& origin, const glm::vec3& u, const glm::vec3& v, std::uint32_t material);
  /// An octahedron of 8 subdivisions^2 triangles with all vertices on the sphere, seen counter-clockwise from outside.
  /// With pathtracer::triangle_smooth in the material the vertices have the sphere's normals.
  void add_sphere(const glm::dvec3& centre, double radius, int subdivisions, std::uint32_t material);
  /// Makes every emissive triangle a light, all with equal probability.
  void add_lights();
  /// A closed box of quads that are seen counter-clockwise from outside.
  void add_box(const glm::vec3& minimum, const glm::vec3& maximum, std::uint32_t material);
};

pathtracer::GpuMaterial diffuse(const glm::vec3& albedo, const glm::vec3& emission = glm::vec3(0));
pathtracer::GpuMaterial mirror(const glm::vec3& reflectance);
pathtracer::GpuMaterial glass(float ior);

/// A scene on a device: the buffers of shaders/scene.glsl and one instance of all triangles.
struct DeviceScene {
  rhi::BufferHandle positions;
  rhi::BufferHandle normals;
  rhi::BufferHandle triangles;
  rhi::BufferHandle materials;
  rhi::BufferHandle lights;
  rhi::BufferHandle primitive_lights;
  rhi::BufferHandle environment_cells;
  rhi::BufferHandle media;
  rhi::BufferHandle unused;  ///< stands in for what the scene has nothing of
  rhi::AccelerationStructureHandle bottom_level;
  rhi::AccelerationStructureHandle top_level;
};

DeviceScene upload(rhi::Device& device, const TestScene& scene);

/// What path_trace.comp is told, in both of its parts.
struct RenderConstants : pathtracer::RenderConstants {
  pathtracer::DispatchConstants dispatch;
};

/// A camera at `position` that looks along -z with y up and half a field of view of 45 degrees each way.
RenderConstants render_constants(const glm::vec3& position, std::uint32_t width, std::uint32_t height,
                                 const TestScene& scene);

/// For a bind group of set 0. @param constants a buffer of one RenderConstants
std::vector<rhi::BindGroupEntry> scene_entries(const rhi::PipelineInterface& interface, const DeviceScene& scene,
                                               const rhi::BufferHandle& constants);

struct Rendering {
  std::vector<float> radiance_sum;  ///< r, g, b of each pixel
  std::vector<std::uint32_t> ray_counts;
};

/// path_trace.comp. @param features bit i is the specialisation constant i of shaders/features.glsl
rhi::ComputePipelineHandle path_trace_pipeline(rhi::Device& device, std::uint32_t features = 0);

/// Runs path_trace.comp once for each of `dispatches`, which share a resolution.
Rendering path_trace(rhi::Device& device, const rhi::ComputePipelineHandle& pipeline, const DeviceScene& scene,
                     const std::vector<RenderConstants>& dispatches);
Rendering path_trace(rhi::Device& device, const DeviceScene& scene, const std::vector<RenderConstants>& dispatches);

}  // namespace tandem::test
