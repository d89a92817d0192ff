#include "pathtracer/load/generate.hpp"

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "base/error.hpp"
#include "pathtracer/load/obj/obj_loader.hpp"
#include "pathtracer/scene/lights.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem::pathtracer;
using tandem::test::ScratchFolder;

namespace {

std::string contents_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("A generated scene has about the triangles asked for, and loads") {
  const ScratchFolder folder;
  for (const std::uint64_t wanted : {26u, 100u, 1000u, 10'000u, 100'000u}) {
    const std::filesystem::path path = folder.path() / "spheres.obj";
    const std::uint64_t written = generate_spheres(wanted, path);
    const Scene scene = load_obj(path);
    CHECK(scene.triangles.size() == written);
    CHECK(scene.warnings.empty());
    CHECK(build_lights(scene).size() == 2);
    if (wanted >= 1000) CHECK(double(written) == doctest::Approx(double(wanted)).epsilon(0.02));
  }
}

TEST_CASE("The same count gives the same bytes and nothing but the two files") {
  const ScratchFolder folder;
  generate_spheres(5000, folder.path() / "a.obj");
  const std::string first = contents_of(folder.path() / "a.obj");
  generate_spheres(5000, folder.path() / "a.obj");
  CHECK(contents_of(folder.path() / "a.obj") == first);
  CHECK(folder.names().size() == 2);
}

TEST_CASE("Generated spheres are closed, look outwards and stay inside the room and apart") {
  const ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "spheres.obj";
  generate_spheres(20'000, path);
  const Scene scene = load_obj(path);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0;
  for (std::size_t i = 18; i < scene.triangles.size(); ++i) {
    const std::uint32_t* const v = scene.triangles[i].vertices;
    for (int corner = 0; corner < 3; ++corner) ++edges[{v[corner], v[(corner + 1) % 3]}];
    const glm::dvec3 a(scene.positions[v[0]]), b(scene.positions[v[1]]), c(scene.positions[v[2]]);
    volume += glm::dot(a, glm::cross(b, c)) / 6;
    // The height keeps clear of the light; the sides are the smallest ones of the measured box.
    for (const glm::dvec3& p : {a, b, c}) CHECK(glm::all(glm::greaterThan(p, glm::dvec3(0))));
    for (const glm::dvec3& p : {a, b, c}) CHECK(glm::all(glm::lessThan(p, glm::dvec3(549.6, 420, 559.2))));
  }
  for (const auto& [edge, count] : edges) {
    CHECK(count == 1);
    CHECK(edges.contains({edge.second, edge.first}));
  }
  // 27 spheres of radius 58 whose displacement averages near zero: an eighth covers waves that do not.
  CHECK(volume == doctest::Approx(27 * 4.0 / 3.0 * 3.14159265 * 58 * 58 * 58).epsilon(0.125));
}

TEST_CASE("Counts out of range and places that cannot be written are errors that leave nothing behind") {
  const ScratchFolder folder;
  CHECK_THROWS_AS(generate_spheres(25, folder.path() / "a.obj"), tandem::Error);
  CHECK_THROWS_AS(generate_spheres(maximum_generated_triangles + 1, folder.path() / "a.obj"), tandem::Error);
  CHECK_THROWS_AS(generate_spheres(100, folder.path() / "a.txt"), tandem::Error);
  CHECK_THROWS_AS(generate_spheres(100, folder.path() / "absent" / "a.obj"), tandem::Error);
  CHECK_THROWS_AS(generate_spheres(100, folder.path()), tandem::Error);
  CHECK(folder.names().size() == 0);
}
