#include "pathtracer/scene/panes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

namespace tandem::pathtracer {
namespace {

using Place = std::array<float, 3>;
using Edge = std::pair<Place, Place>;

Place place_of(const Scene& scene, std::uint32_t vertex) {
  const glm::vec3 position = scene.positions[vertex] + 0.0f;  // -0 is 0
  return {position.x, position.y, position.z};
}

bool is_glass(const GpuMaterial& material) {
  return material.model == MaterialModel::dielectric || material.model == MaterialModel::rough_dielectric;
}

template <typename Function>
void for_edges(const Scene& scene, const GpuTriangle& triangle, Function function) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Place a = place_of(scene, triangle.vertices[i]);
    const Place b = place_of(scene, triangle.vertices[(i + 1) % 3]);
    if (a != b) function(a < b ? Edge(a, b) : Edge(b, a));
  }
}

}  // namespace

std::vector<std::uint32_t> open_dielectrics(const Scene& scene) {
  const auto material_of = [](const GpuTriangle& triangle) { return triangle.material & ~triangle_smooth; };
  if (std::ranges::none_of(scene.materials, is_glass)) return {};
  std::map<Edge, std::size_t> uses;  // of the edges of glass, by all triangles
  for (const GpuTriangle& triangle : scene.triangles)
    if (is_glass(scene.materials[material_of(triangle)]))
      for_edges(scene, triangle, [&](const Edge& edge) { uses.try_emplace(edge, 0); });
  for (const GpuTriangle& triangle : scene.triangles)
    for_edges(scene, triangle, [&](const Edge& edge) {
      if (const auto found = uses.find(edge); found != uses.end()) ++found->second;
    });
  std::set<std::uint32_t> open;
  for (const GpuTriangle& triangle : scene.triangles)
    if (is_glass(scene.materials[material_of(triangle)]))
      for_edges(scene, triangle, [&](const Edge& edge) {
        if (uses.at(edge) == 1) open.insert(material_of(triangle));
      });
  return {open.begin(), open.end()};
}

void make_panes(Scene& scene, const std::vector<std::uint32_t>& materials) {
  for (const std::uint32_t material : materials) scene.materials[material].model = MaterialModel::thin;
}

}  // namespace tandem::pathtracer
