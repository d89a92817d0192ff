#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rhi/device.hpp"

/// Triangles to trace rays against, and a shader that answers what a ray meets.
namespace tandem::test {

/// One ray, as rayQueryInitializeEXT takes it. Layout of the shader's Ray, std430.
struct ProbeRay {
  std::array<float, 3> origin = {0, 0, 5};
  float t_min = 0;
  std::array<float, 3> direction = {0, 0, -1};
  float t_max = 100;
  std::uint32_t flags = 0;  ///< gl_RayFlags*EXT
  std::uint32_t mask = 0xff;
  std::uint32_t confirm = 1;  ///< 1: every candidate is confirmed, 0: none is
  std::uint32_t padding = 0;
};
static_assert(sizeof(ProbeRay) == 48);

/// The committed intersection. Layout of the shader's Hit, std430.
struct ProbeHit {
  std::uint32_t type = 0;  ///< 0: none, 1: triangle
  float t = 0;
  std::array<float, 2> barycentrics = {};
  std::uint32_t instance = 0;
  std::uint32_t custom_index = 0;
  std::uint32_t geometry = 0;
  std::uint32_t primitive = 0;
  std::uint32_t front_face = 0;
  std::uint32_t sbt_offset = 0;
  std::uint32_t candidates = 0;  ///< how many triangles rayQueryProceedEXT offered; their number is not defined
  std::uint32_t padding = 0;
};
static_assert(sizeof(ProbeHit) == 48);

/// What each ray meets in the built top level.
std::vector<ProbeHit> trace(rhi::Device& device, const rhi::AccelerationStructureHandle& top_level,
                            const std::vector<ProbeRay>& rays);

/// Positions of triangles in the plane z, three vertices each.
std::vector<float> triangle_at(float x, float y, float z);

/// Non-indexed triangles over `positions`, in a buffer of their own.
rhi::TriangleGeometry triangles_of(rhi::Device& device, const std::vector<float>& positions,
                                   rhi::GeometryFlags flags = rhi::GeometryFlags::opaque);

/// A bottom level of these geometries, built.
rhi::AccelerationStructureHandle build_bottom_level(rhi::Device& device, std::vector<rhi::Geometry> geometries,
                                                    const std::string& label = "bottom level");

/// A top level of these instances, built.
rhi::AccelerationStructureHandle build_top_level(rhi::Device& device, const std::vector<rhi::InstanceDesc>& instances,
                                                 const std::string& label = "top level");

}  // namespace tandem::test
