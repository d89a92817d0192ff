#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compare/probe/ray.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::test {

/// Rays from places in and around the scene towards points of its surfaces; a third of them start near one. Pixel x of
/// ray i is i.
std::vector<compare::PathRay> rays_through(const pathtracer::Scene& scene, std::size_t count, std::uint32_t seed);

/// Triangles of all sizes and shapes in the unit cube, some of them degenerate, with spheres among them.
pathtracer::Scene soup(std::size_t triangle_count, std::size_t sphere_count, std::uint32_t seed);

}  // namespace tandem::test
