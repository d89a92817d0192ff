#pragma once

#include <array>
#include <optional>

#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/trace/exact/transform.hpp"
#include "rhi_cpu/trace/geometry_input.hpp"

namespace tandem::cpu::exact {

/// Where the line of a ray meets a triangle: exact values, each rounded once, to the nearest float.
struct TriangleHit {
  float t;  ///< anywhere on the line
  std::array<float, 2> barycentrics;
  bool front_face;  ///< (v1 - v0) x (v2 - v0) of object space points against the ray
};

/// The edges and vertices belong to the triangle. A line in its plane does not meet it.
/// @param corners finite
/// @param ray finite; its t_min and t_max are not looked at
std::optional<TriangleHit> intersect(const kernel::Ray& ray, const Transform& transform,
                                     const std::array<Position, 3>& corners);

}  // namespace tandem::cpu::exact
