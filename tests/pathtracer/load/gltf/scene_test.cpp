#include <algorithm>
#include <filesystem>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include "pathtracer/load/gltf/loader.hpp"

using namespace tandem::pathtracer;

namespace {

const std::filesystem::path file = std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "scenes" / "still_life.glb";

}  // namespace

TEST_CASE("The glTF scene that ships holds what it is meant to show, and nothing that is not read") {
  const Scene scene = load_gltf(file);
  CHECK(scene.warnings.empty());
  CHECK(scene.camera);
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].kind == LightKind::spot);
  CHECK(std::ranges::count_if(scene.materials, [](const GpuMaterial& m) { return m.emission != glm::vec3(0); }) == 1);
  CHECK(std::ranges::count_if(scene.materials, [](const GpuMaterial& m) { return m.alpha_cutoff > 0; }) == 1);
  CHECK(std::ranges::count_if(scene.materials, [](const GpuMaterial& m) { return m.transmission > 0; }) == 1);
  CHECK(std::ranges::count_if(scene.materials, [](const GpuMaterial& m) { return m.normal_texture != no_texture; }) ==
        3);
  CHECK(scene.images.size() == 7);
  CHECK(std::filesystem::file_size(file) < 600 * 1024);
}

TEST_CASE("In the glTF scene that ships, normals point to the side from which triangles are counter-clockwise") {
  const Scene scene = load_gltf(file);
  std::size_t smooth = 0, turned = 0;
  for (const GpuTriangle& triangle : scene.triangles) {
    if ((triangle.material & triangle_smooth) == 0) continue;
    const auto& [a, b, c] = triangle.vertices;
    const glm::vec3 own = glm::cross(scene.positions[b] - scene.positions[a], scene.positions[c] - scene.positions[a]);
    ++smooth;
    turned += glm::dot(own, scene.normals[a] + scene.normals[b] + scene.normals[c]) < 0 ? 1 : 0;
  }
  CHECK(smooth > 10000);
  CHECK(turned == 0);
}
