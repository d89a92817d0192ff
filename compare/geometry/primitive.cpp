#include "compare/geometry/primitive.hpp"

#include <cstddef>

namespace tandem::compare {

Corners corners_of(const pathtracer::Scene& scene, std::uint32_t triangle) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = glm::dvec3(scene.positions[scene.triangles[triangle].vertices[i]]);
  return corners;
}

const pathtracer::GpuSphere* sphere_of(const pathtracer::Scene& scene, std::uint32_t answer) {
  const std::size_t index = std::size_t{answer} - scene.triangles.size();
  return answer >= scene.triangles.size() && index < scene.spheres.size() ? &scene.spheres[index] : nullptr;
}

}  // namespace tandem::compare
