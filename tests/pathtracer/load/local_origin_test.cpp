// Scenes at map coordinates keep the centimetres that floats would lose there.

#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "pathtracer/load/scene_loader.hpp"
#include "pathtracer/scene/local_origin.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

const glm::dvec3 utm(450000, 100, -5400000);

std::string point(const glm::dvec3& p) { return fmt::format("[{}, {}, {}]", p.x, p.y, p.z); }

/// Everything that has a position, moved by `by`.
std::string description(const glm::dvec3& by) {
  const auto at = [&](double x, double y, double z) { return point(by + glm::dvec3(x, y, z)); };
  return fmt::format(
      R"({{"boxes": [{{"minimum": {}, "maximum": {}, "material": "m"}}],
"quads": [{{"corner": {}, "u": [8, 0, 0], "v": [0, 0, -8], "material": "m"}}],
"spheres": [{{"centre": {}, "radius": 0.5, "material": "m"}}],
"models": [{{"file": "triangle.obj", "transform": [{{"translate": {}}}]}}],
"lights": [{{"type": "point", "position": {}, "intensity": 1}},
{{"type": "sphere", "centre": {}, "radius": 0.25, "radiance": 1}},
{{"type": "rectangle", "corner": {}, "u": [1, 0, 0], "v": [0, 0, 1], "radiance": 1}}],
"camera": {{"position": {}, "target": {}}}, "materials": {{"m": {{"model": "diffuse"}}}}}})",
      at(-1.25, 0.01, 0.02), at(1.5, 1.03, 2), at(-4, 0, 4), at(2.01, 0.5, 0), at(0.03, 0.02, 0.01), at(0, 3.01, 0),
      at(0, 4.01, 0), at(0, 5.01, 0), at(3.01, 2, 7), at(0.02, 0, 0));
}

constexpr double rounding = 2e-6;  // of a float up to 16, four times

void check_moved(const Scene& near, const Scene& far, const glm::dvec3& by) {
  const auto same = [&](const glm::vec3& a, const glm::vec3& b) {
    CHECK(glm::length(glm::dvec3(a) + near.origin + by - (glm::dvec3(b) + far.origin)) < rounding);
  };
  REQUIRE(near.positions.size() == far.positions.size());
  for (std::size_t i = 0; i < near.positions.size(); ++i) same(near.positions[i], far.positions[i]);
  REQUIRE(near.spheres.size() == far.spheres.size());
  for (std::size_t i = 0; i < near.spheres.size(); ++i) same(near.spheres[i].centre, far.spheres[i].centre);
  REQUIRE(near.lights.size() == far.lights.size());
  for (std::size_t i = 0; i < near.lights.size(); ++i) same(near.lights[i].position, far.lights[i].position);
  REQUIRE(near.camera.has_value() == far.camera.has_value());
  if (!near.camera) return;
  same(near.camera->position, far.camera->position);
  // How far away the target is does not matter.
  const auto view = [](const Camera& camera) {
    return glm::normalize(glm::dvec3(camera.target) - glm::dvec3(camera.position));
  };
  CHECK(glm::length(view(*near.camera) - view(*far.camera)) < rounding);
}

}  // namespace

TEST_CASE("A description at map coordinates, with lights, camera and models, is that at 0 moved") {
  const test::ScratchFolder folder;
  folder.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0.01\nf 1 2 3\n");
  const Scene near = load_scene(folder.write("near.json", description(glm::dvec3(0))));
  CHECK(near.origin == glm::dvec3(0));
  for (const glm::dvec3& by : {utm, 1e3 * utm}) {
    const Scene far = load_scene(folder.write("far.json", description(by)));
    CHECK(glm::length(far.origin - by) < 300);
    check_moved(near, far, by);
  }
}

TEST_CASE("An OBJ file at map coordinates keeps its centimetres, as itself and as a model of a description") {
  const test::ScratchFolder folder;
  const char* const near_text = "v 0.01 0 0.02\nv 7.03 0 0\nv 0 5.04 0.05\nf 1 2 3\n";
  const char* const far_text =
      "v 450000.01 100 -5399999.98\nv 450007.03 100 -5400000\nv 450000 105.04 -5399999.95\nf 1 2 3\n";
  const Scene near = load_scene(folder.write("near.obj", near_text));
  const Scene far = load_scene(folder.write("far.obj", far_text));
  check_moved(near, far, utm);

  // Brought back to 0, it needs no origin.
  const Scene placed = load_scene(folder.write(
      "placed.json", R"({"models": [{"file": "far.obj", "transform": [{"translate": [-450000, -100, 5400000]}]}]})"));
  CHECK(placed.origin == glm::dvec3(0));
  check_moved(near, placed, glm::dvec3(0));
}

TEST_CASE("A glTF file whose nodes are at map coordinates keeps its centimetres") {
  const test::ScratchFolder folder;
  // One triangle 0 0 0, 1 0 0, 0 1 0, below two nodes.
  const auto text = [](const glm::dvec3& parent) {
    return fmt::format(
        R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"translation": {}, "children": [1, 2, 3]}}, {{"mesh": 0, "translation": [0.01, 0.02, 0.03]}},
{{"camera": 0, "translation": [0.01, 0, 5]}}, {{"translation": [0, 3.01, 0], "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}}],
"cameras": [{{"type": "perspective", "perspective": {{"yfov": 0.7, "znear": 0.01}}}}],
"extensionsUsed": ["KHR_lights_punctual"],
"extensions": {{"KHR_lights_punctual": {{"lights": [{{"type": "point"}}]}}}},
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
"accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}}],
"bufferViews": [{{"buffer": 0, "byteLength": 36}}],
"buffers": [{{"byteLength": 36,
"uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}]}})",
        point(parent));
  };
  const Scene near = load_scene(folder.write("near.gltf", text(glm::dvec3(0))));
  CHECK(near.origin == glm::dvec3(0));
  const Scene far = load_scene(folder.write("far.gltf", text(utm)));
  check_moved(near, far, utm);
}

TEST_CASE("What is near 0, or large, keeps its coordinates") {
  const auto scene = [](glm::vec3 centre, float half) {
    Scene result;
    result.spheres.push_back({.centre = centre, .radius = half});
    return result;
  };
  CHECK(local_origin(scene({278, 278, 278}, 278)) == glm::dvec3(0));
  CHECK(local_origin(scene({15, 0, 0}, 1)) == glm::dvec3(0));
  CHECK(local_origin(scene({0, 1e6f, 0}, 1e6f)) == glm::dvec3(0));
  CHECK(local_origin(scene({17, 15, -1000}, 1)) == glm::dvec3(17, 0, -1000));
  CHECK(local_origin(scene({450010, 0, 0}, 60)) == glm::dvec3(449984, 0, 0));  // a multiple of 64
}
