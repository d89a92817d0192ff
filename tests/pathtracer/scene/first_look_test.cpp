// What makes a model well seen that is opened for the first time: a studio light, and panes.

#include <doctest/doctest.h>

#include "pathtracer/load/obj/obj_loader.hpp"
#include "pathtracer/scene/lights.hpp"
#include "pathtracer/scene/panes.hpp"
#include "pathtracer/scene/studio.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

Scene load(const std::string& obj, const std::string& mtl) {
  const test::ScratchFolder folder;
  folder.write("m.mtl", mtl);
  return load_obj(folder.write("m.obj", "mtllib m.mtl\n" + obj));
}

const std::string cube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "usemtl m\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n";

}  // namespace

TEST_CASE("A scene's own light is none, negligible or sufficient") {
  const std::string lid = "usemtl lid\nf 4 1 5 8\n";
  CHECK(own_light(load(cube + lid, "newmtl m\nKd 1\nnewmtl lid\nKd 1\n")) == OwnLight::none);
  CHECK(own_light(load(cube + lid, "newmtl m\nKd 1\nnewmtl lid\nKe 1\n")) == OwnLight::sufficient);
  CHECK(own_light(load(cube + lid, "newmtl m\nKd 1\nnewmtl lid\nKe 0.01\n")) == OwnLight::negligible);
  Scene lit = load(cube + lid, "newmtl m\nKd 1\nnewmtl lid\nKd 1\n");
  lit.lights.push_back({.radiance = glm::vec3(1e-9f)});
  CHECK(own_light(lit) == OwnLight::sufficient);  // on purpose
}

TEST_CASE("A studio lights a scene, and is a valid environment") {
  Scene scene = load(cube, "newmtl m\nKd 1\n");
  add_studio(scene);
  CHECK(own_light(scene) == OwnLight::sufficient);
  REQUIRE(scene_emitters(scene).size() == 1);
  CHECK(scene.texture_coordinates.size() == scene.positions.size());
}

TEST_CASE("Dielectrics whose mesh is open are found, once for each material, and become panes") {
  const std::string glass = "newmtl m\nillum 4\nNi 1.5\nnewmtl lid\nKd 1\nnewmtl pane\nillum 4\nNi 1.5\n";
  const std::string lid = "f 4 1 5 8\n";
  CHECK(open_dielectrics(load(cube + lid, glass)).empty());
  CHECK(open_dielectrics(load(cube + "usemtl lid\n" + lid, glass)).empty());  // closed by another material
  CHECK(open_dielectrics(load(cube + "usemtl pane\nv 3 0 0\nv 4 0 0\nv 4 1 0\nv 3 1 0\nf 9 10 11 12\n", glass)) ==
        std::vector<std::uint32_t>{0, 2});
  Scene pane = load("v 3 0 0\nv 4 0 0\nv 4 1 0\nv 3 1 0\nusemtl pane\nf 1 2 3 4\n", glass);
  const std::vector<std::uint32_t> open = open_dielectrics(pane);
  CHECK(open == std::vector<std::uint32_t>{2});
  make_panes(pane, open);
  CHECK(pane.materials[2].model == MaterialModel::thin);
  CHECK(open_dielectrics(pane).empty());
}
