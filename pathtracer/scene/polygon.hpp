#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace tandem::pathtracer {

/// Splits a polygon of n >= 3 corners into n - 2 triangles of the same winding, as indices into `corners`. The polygon
/// may be concave and slightly out of plane; a convex quadrilateral is split along its shorter diagonal. One that
/// crosses itself or has no area still gives n - 2 triangles, which then may overlap. Takes O(n log n) for usual
/// shapes; throws Error for one that would take much longer.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const glm::vec3> corners);

}  // namespace tandem::pathtracer
