#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "rhi/device.hpp"

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

/// A buffer of `bytes`, with every usage that the device has.
rhi::BufferHandle buffer_of_bytes(rhi::Device& device, std::span<const std::byte> bytes, const std::string& label);

/// A buffer of `values`, which are not none.
template <typename T>
rhi::BufferHandle buffer_of(rhi::Device& device, const std::vector<T>& values, const std::string& label) {
  return buffer_of_bytes(device, std::as_bytes(std::span(values)), label);
}

/// Waits for the device, then reads `count` T from byte `offset` on.
template <typename T>
std::vector<T> contents(rhi::Device& device, const rhi::BufferHandle& buffer, std::size_t count,
                        std::uint64_t offset = 0) {
  std::vector<T> values(count);
  device.download(buffer, offset, std::as_writable_bytes(std::span(values)));
  return values;
}

/// The corners (0, 0, 0), (1, 0, 0), (0, 1, 0), moved by `place`. Their normal is +z, so a ray that comes from there
/// meets the front face (docs/internals/rhi-contract.md).
std::vector<glm::vec3> triangle_at(glm::vec3 place);

/// Triangles that have three vertices of their own each.
rhi::TriangleGeometry triangles(rhi::Device& device, const std::vector<glm::vec3>& vertices,
                                rhi::GeometryFlags flags = rhi::GeometryFlags::opaque);

rhi::AabbGeometry boxes(rhi::Device& device, const std::vector<Box>& boxes,
                        rhi::GeometryFlags flags = rhi::GeometryFlags::opaque);

/// A bottom level, built.
rhi::AccelerationStructureHandle build_bottom_level(rhi::Device& device, const rhi::BottomLevelDesc& desc);
rhi::AccelerationStructureHandle build_bottom_level(rhi::Device& device, std::vector<rhi::Geometry> geometries);

/// What builds a top level of these instances; no instances: an empty one.
rhi::TopLevelDesc top_level_of(rhi::Device& device, const std::vector<rhi::InstanceDesc>& instances,
                               rhi::BuildFlags flags = rhi::BuildFlags::prefer_fast_trace);

/// A top level, built. It keeps no bottom level alive.
rhi::AccelerationStructureHandle build_top_level(rhi::Device& device, const rhi::TopLevelDesc& desc);
rhi::AccelerationStructureHandle build_top_level(rhi::Device& device, const std::vector<rhi::InstanceDesc>& instances);

/// A bottom level and a top level with one instance of it.
struct Scene {
  rhi::AccelerationStructureHandle bottom_level;
  rhi::AccelerationStructureHandle top_level;
};
Scene build_scene(rhi::Device& device, std::vector<rhi::Geometry> geometries, const Transform& transform = identity,
                  rhi::InstanceFlags flags = rhi::InstanceFlags::none);

}  // namespace tandem::conformance
