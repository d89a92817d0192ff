#include <filesystem>
#include <string>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include "pathtracer/load/obj/obj_loader.hpp"
#include "pathtracer/scene/lights.hpp"
#include "tests/support/run_summary.hpp"

using namespace tandem::pathtracer;

namespace {

const std::filesystem::path source_directory = TANDEM_SOURCE_DIRECTORY;

glm::dvec3 normal_of(const Scene& scene, const GpuTriangle& triangle) {
  const glm::dvec3 a(scene.positions[triangle.vertices[0]]);
  return glm::cross(glm::dvec3(scene.positions[triangle.vertices[1]]) - a,
                    glm::dvec3(scene.positions[triangle.vertices[2]]) - a);
}

}  // namespace

TEST_CASE("The Cornell box is the measured one") {
  const Scene scene = load_obj(source_directory / "scenes" / "cornell_box.obj");
  CHECK(scene.warnings.empty());
  CHECK(scene.triangles.size() == 18 + 2 * 10);
  const std::vector<GpuLight> lights = build_lights(scene);
  REQUIRE(lights.size() == 2);
  double light_area = 0;
  for (const GpuLight& light : lights) {
    const GpuTriangle& triangle = scene.triangles[light.primitive];
    light_area += triangle_area(scene, triangle);
    CHECK(normal_of(scene, triangle).y < 0);
    CHECK(scene.materials[triangle.material].emission == glm::vec3(17, 12, 4));
  }
  CHECK(light_area == doctest::Approx(130.0 * 105.0));
  const Bounds box = bounds(scene);
  CHECK(box.minimum == glm::vec3(0));
  CHECK(box.maximum == glm::vec3(556, 548.8f, 559.2f));
}

TEST_CASE("No two faces of the shipped scenes overlap in a plane") {
  for (const char* name : {"cornell_box.obj", "cornell_spheres.obj"}) {
    const Scene scene = load_obj(source_directory / "scenes" / name);
    // The light fills the hole of the ceiling exactly, so that everything at its height adds up to the ceiling outline.
    double at_ceiling = 0;
    for (const GpuTriangle& triangle : scene.triangles) {
      bool flat = true;
      for (const std::uint32_t vertex : triangle.vertices) flat = flat && scene.positions[vertex].y == 548.8f;
      if (flat) at_ceiling += triangle_area(scene, triangle);
    }
    CHECK(at_ceiling == doctest::Approx(556 * 559.2).epsilon(1e-6));
    // Nothing but the floor lies in the floor's plane.
    double at_floor = 0;
    for (const GpuTriangle& triangle : scene.triangles) {
      bool flat = true;
      for (const std::uint32_t vertex : triangle.vertices) flat = flat && scene.positions[vertex].y == 0;
      if (flat) at_floor += triangle_area(scene, triangle);
    }
    CHECK(at_floor == doctest::Approx((552.8 + 549.6) / 2 * 559.2).epsilon(1e-6));
  }
}

TEST_CASE("The spheres of cornell_spheres.obj are a mirror and glass, smooth and looking outwards") {
  const std::filesystem::path path = source_directory / "scenes" / "cornell_spheres.obj";
  CHECK(std::filesystem::file_size(path) < 1'000'000);
  const Scene scene = load_obj(path);
  CHECK(scene.warnings.empty());
  std::size_t mirrors = 0, glasses = 0;
  for (const GpuTriangle& triangle : scene.triangles) {
    const GpuMaterial& material = scene.materials[triangle.material & ~triangle_smooth];
    if (material.model == MaterialModel::diffuse) continue;
    (material.model == MaterialModel::mirror ? mirrors : glasses) += 1;
    CHECK((triangle.material & triangle_smooth) != 0);
    for (const std::uint32_t vertex : triangle.vertices)
      CHECK(glm::dot(normal_of(scene, triangle), glm::dvec3(scene.normals[vertex])) > 0);
    if (material.model == MaterialModel::dielectric) CHECK(material.ior == 1.5f);
  }
  CHECK(mirrors == 20 * 256);
  CHECK(glasses == 20 * 256);
}

TEST_CASE("The scenes of the thesis load") {
  const std::filesystem::path folder = source_directory.parent_path() / "shared" / "scenes" / "thesis";
  if (!std::filesystem::is_directory(folder)) TANDEM_SKIP(folder.string() + " is not there");
  int count = 0;
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".obj") continue;
    CAPTURE(entry.path().string());
    // water.obj names an MTL file, and Medieval_building.obj a texture, that the thesis never had.
    const bool incomplete = entry.path().stem() == "water" || entry.path().stem() == "Medieval_building";
    const Scene scene = load_obj(entry.path(), {.allow_missing_mtl = incomplete});
    CHECK_FALSE(scene.triangles.empty());
    ++count;
  }
  CHECK(count == 22);
}
