#pragma once

#include "rhi_cpu/trace/embree/scene.hpp"

namespace tandem::cpu {

/// For a ray that has met nothing: the triangle that it hits at a vertex, where Embree may have lost it.
///
/// Embree's test of a triangle is consistent along edges: of the two triangles at one, at least one is hit. At a vertex
/// it is not: when rounding gives the ray the same side of all edges that meet there, it slips between their triangles
/// (some rays in a thousand that are aimed at a vertex do). So the ray is traced once more, a little to the side, which
/// leads it clear of the vertex; a triangle that is met then counts if rounding cannot tell whether the ray itself
/// meets it. The flags and the mask of the ray hold.
///
/// Rays that stop at the first hit go without: most of them meet nothing, and would all be traced twice.
bool find_vertex_hit(const TopLevelScene& scene, const kernel::Ray& ray, kernel::Hit& hit);

}  // namespace tandem::cpu
