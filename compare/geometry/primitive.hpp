#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

#include "pathtracer/scene/scene.hpp"

/// The primitives of a scene by the numbers that TracedRay::answer gives them: triangles first, then spheres.
namespace tandem::compare {

/// The corners of a triangle.
using Corners = std::array<glm::dvec3, 3>;

/// @param triangle less than the number of triangles
Corners corners_of(const pathtracer::Scene& scene, std::uint32_t triangle);

/// The sphere that an answer names; null when it names a triangle or nothing.
const pathtracer::GpuSphere* sphere_of(const pathtracer::Scene& scene, std::uint32_t answer);

}  // namespace tandem::compare
