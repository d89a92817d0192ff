#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "rhi/build.hpp"
#include "rhi/device.hpp"
#include "rhi/transfer.hpp"

/// Small scenes for cases to trace rays in.
namespace tandem::conformance {

/// Row-major 3x4, as rhi::InstanceDesc and rhi::TriangleGeometry::transform hold it.
using Transform = std::array<float, 12>;
inline constexpr Transform identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

constexpr Transform translation(float x, float y, float z) { return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z}; }

/// An axis-aligned box, as rhi::AabbGeometry holds it.
struct Box {
  glm::vec3 minimum = glm::vec3(0);
  glm::vec3 maximum = glm::vec3(1);
};
static_assert(sizeof(Box) == 24);

/// Every usage that a buffer can have.
inline constexpr rhi::BufferUsage any_usage = rhi::BufferUsage::storage | rhi::BufferUsage::uniform |
                                              rhi::BufferUsage::acceleration_structure_input |
                                              rhi::BufferUsage::device_address | rhi::BufferUsage::indirect;

/// A buffer of `values`, which are not none, for any usage.
template <typename T>
rhi::BufferHandle buffer_of(rhi::Device& device, const std::vector<T>& values, const std::string& label) {
  return rhi::create_filled(device, values, any_usage, label);
}

/// The corners (0, 0, 0), (1, 0, 0), (0, 1, 0), moved by `place`. Their normal is +z, so a ray that comes from there
/// meets the front face (docs/internals/rhi-contract.md).
std::vector<glm::vec3> triangle_at(glm::vec3 place);

/// Triangles that have three vertices of their own each.
rhi::TriangleGeometry triangles(rhi::Device& device, const std::vector<glm::vec3>& vertices,
                                rhi::GeometryFlags flags = rhi::GeometryFlags::opaque);

rhi::AabbGeometry boxes(rhi::Device& device, const std::vector<Box>& boxes,
                        rhi::GeometryFlags flags = rhi::GeometryFlags::opaque);

/// A bottom level of these geometries, built; of a description: rhi/build.hpp.
rhi::AccelerationStructureHandle build_bottom_level(rhi::Device& device, std::vector<rhi::Geometry> geometries);

/// What builds a top level of these instances; no instances: an empty one.
rhi::TopLevelDesc top_level_of(rhi::Device& device, const std::vector<rhi::InstanceDesc>& instances,
                               rhi::BuildFlags flags = rhi::BuildFlags::prefer_fast_trace);

/// A top level of these instances, built. It keeps no bottom level alive.
rhi::AccelerationStructureHandle build_top_level(rhi::Device& device, const std::vector<rhi::InstanceDesc>& instances);

/// A bottom level and a top level with one instance of it.
struct Scene {
  rhi::AccelerationStructureHandle bottom_level;
  rhi::AccelerationStructureHandle top_level;
};
Scene build_scene(rhi::Device& device, std::vector<rhi::Geometry> geometries, const Transform& transform = identity,
                  rhi::InstanceFlags flags = rhi::InstanceFlags::none);

}  // namespace tandem::conformance
