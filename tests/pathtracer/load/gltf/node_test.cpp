#include <cmath>
#include <numbers>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include "pathtracer/load/gltf/loader.hpp"
#include "tests/pathtracer/load/gltf/file.hpp"

using namespace tandem::pathtracer;
using namespace tandem::test;

namespace {

void check_near(glm::vec3 a, glm::vec3 b) {
  CAPTURE(a.x);
  CAPTURE(a.y);
  CAPTURE(a.z);
  CHECK(glm::length(a - b) < 1e-6f);  // a few roundings of numbers of about 1
}

const double half_root = std::sqrt(0.5);

/// A file whose mesh 0 is the triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) with normals that lean towards +x.
GltfFile file_with_mesh() {
  GltfFile file;
  file.add_mesh({{"attributes",
                  {{"POSITION", file.add_vectors({0, 0, 0, 1, 0, 0, 0, 1, 0})},
                   {"NORMAL", file.add_vectors({0.6f, 0, 0.8f, 0.6f, 0, 0.8f, 0.6f, 0, 0.8f})}}}});
  return file;
}

glm::vec3 normal(const Scene& scene, std::size_t triangle) {
  const auto& [a, b, c] = scene.triangles[triangle].vertices;
  return glm::normalize(glm::cross(scene.positions[b] - scene.positions[a], scene.positions[c] - scene.positions[a]));
}

}  // namespace

TEST_CASE("glTF: transforms of nested nodes apply from the inside to the outside: scale, rotation, translation") {
  GltfFile file = file_with_mesh();
  // A quarter turn about z: x to y.
  const int child = file.add(
      "nodes",
      {{"mesh", 0}, {"scale", {2, 3, 1}}, {"rotation", {0, 0, half_root, half_root}}, {"translation", {10, 0, 0}}});
  // The same again as a matrix, by columns, with a shift along z.
  file.add_node({{"children", {child}}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}});
  const Scene scene = file.load();
  check_near(scene.positions[0], {0, 10, 5});
  check_near(scene.positions[1], {-2, 10, 5});  // (1,0,0) -> (2,0,0) -> (0,2,0) -> (10,2,0) -> (-2,10,5)
  check_near(scene.positions[2], {0, 7, 5});    // (0,1,0) -> (0,3,0) -> (-3,0,0) -> (7,0,0) -> (0,7,5)
  check_near(normal(scene, 0), {0, 0, 1});
  // Normals take the inverse transposed: (0.6 / 2, 0, 0.8), turned by half a turn.
  check_near(scene.normals[0], glm::normalize(glm::vec3(-0.3f, 0, 0.8f)));
  CHECK((scene.triangles[0].material & triangle_smooth) != 0);
}

TEST_CASE("glTF: a mirrored mesh keeps its outside outside") {
  GltfFile file = file_with_mesh();
  file.add_node({{"mesh", 0}});
  file.add_node({{"mesh", 0}, {"scale", {-1, 1, 1}}});
  file.add_node({{"mesh", 0}, {"scale", {-1, -1, -1}}});
  file.add_node({{"mesh", 0}, {"scale", {-1, 1, -1}}});  // a turn, no mirror
  const Scene scene = file.load();
  REQUIRE(scene.triangles.size() == 4);
  check_near(normal(scene, 0), {0, 0, 1});
  check_near(normal(scene, 1), {0, 0, 1});
  check_near(normal(scene, 2), {0, 0, -1});
  check_near(normal(scene, 3), {0, 0, -1});
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::vec3 shading = scene.normals[scene.triangles[i].vertices[0]];
    CHECK(glm::dot(shading, normal(scene, i)) == doctest::Approx(0.8));
    CHECK(shading.x == doctest::Approx(i == 0 ? 0.6 : -0.6));
  }
}

TEST_CASE("glTF: a mesh squashed flat keeps its triangles and finite normals") {
  GltfFile file = file_with_mesh();
  file.add_node({{"mesh", 0}, {"scale", {1, 0, 1}}});
  file.add_node({{"mesh", 0}, {"scale", {1, 1, 0}}});
  const Scene scene = file.load();
  CHECK(scene.triangles.size() == 2);
  CHECK(triangle_area(scene, scene.triangles[0]) == 0);
  for (const glm::vec3 n : scene.normals) CHECK(glm::length(n) == doctest::Approx(1));
}

TEST_CASE("glTF: instances of one mesh are triangles of their own, and the default scene is the one shown") {
  GltfFile file = file_with_mesh();
  for (int i = 0; i < 3; ++i) file.add_node({{"mesh", 0}, {"translation", {i, 0, 0}}});
  CHECK(file.load().triangles.size() == 3);
  file.add("scenes", {{"nodes", {1}}});
  file.json["scene"] = 1;
  const Scene second = file.load();
  CHECK(second.triangles.size() == 1);
  CHECK(second.positions[0] == glm::vec3(1, 0, 0));
  file.json.erase("scene");
  CHECK(file.load().triangles.size() == 3);
  // A file without scenes shows all its nodes, each once.
  file.json.erase("scenes");
  file.json["nodes"][0]["children"] = {2};
  CHECK(file.load().triangles.size() == 3);
}

TEST_CASE("glTF: a chain of very many nodes is no problem") {
  GltfFile file = file_with_mesh();
  constexpr int count = 20000;
  file.add_node({{"children", {1}}, {"translation", {1, 0, 0}}});
  for (int i = 1; i < count; ++i) file.add("nodes", {{"children", {i + 1}}, {"translation", {1, 0, 0}}});
  file.add("nodes", {{"mesh", 0}});
  CHECK(file.load().positions[0] == glm::vec3(count, 0, 0));
}

TEST_CASE("glTF: cameras look along their node's -z") {
  GltfFile file = file_with_mesh();
  file.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}, {"aspectRatio", 2.0}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0.1}, {"zfar", 10}}}}};
  file.add_node({{"mesh", 0}});
  // A quarter turn about y takes -z to -x.
  file.add_node(
      {{"camera", 0}, {"rotation", {0, half_root, 0, half_root}}, {"scale", {2, 2, 2}}, {"translation", {1, 2, 2}}});
  const Scene scene = file.load();
  REQUIRE(scene.camera);
  CHECK(scene.camera->kind == CameraKind::perspective);
  CHECK(scene.camera->vertical_fov == doctest::Approx(180 / std::numbers::pi));
  CHECK(scene.camera->position == glm::vec3(1, 2, 2));
  check_near(glm::normalize(scene.camera->target - scene.camera->position), {-1, 0, 0});
  check_near(scene.camera->up, {0, 1, 0});
  CHECK(scene.camera->lens_radius == 0);
  CHECK(scene.warnings.empty());

  file.json["nodes"][1]["camera"] = 1;
  file.add_node({{"camera", 0}});
  file.add_node({{"camera", 0}});
  const Scene orthographic = file.load();
  REQUIRE(orthographic.camera);
  CHECK(orthographic.camera->kind == CameraKind::orthographic);
  CHECK(orthographic.camera->height == 4);
  REQUIRE(orthographic.warnings.size() == 1);
  CHECK(contains(orthographic.warnings[0], "several cameras"));

  RenderConstants constants;
  set_camera(constants, *scene.camera, 200, 100);
  check_near(constants.camera_forward, {-1, 0, 0});
  check_near(constants.camera_up, {0, static_cast<float>(std::tan(0.5)), 0});
}

TEST_CASE("glTF: punctual lights stand and shine as their nodes say") {
  GltfFile file = file_with_mesh();
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 20}, {"color", {1, 0.5, 0}}},
      {{"type", "directional"}},
      {{"type", "spot"}, {"intensity", 3}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
      {{"type", "spot"}, {"spot", nlohmann::json::object()}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}}};
  file.add_node({{"mesh", 0}});
  for (int i = 0; i < 5; ++i)
    file.add_node({{"translation", {i, 1, 0}},
                   {"rotation", {-half_root, 0, 0, half_root}},  // a quarter turn about -x: -z to -y
                   {"scale", {5, 5, 5}},
                   {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  const Scene scene = file.load();
  REQUIRE(scene.lights.size() == 5);
  CHECK(scene.warnings.empty());
  CHECK(scene.lights[0].kind == LightKind::point);
  CHECK(scene.lights[0].radiance == glm::vec3(20, 10, 0));
  CHECK(scene.lights[0].position == glm::vec3(0, 1, 0));
  CHECK(scene.lights[1].kind == LightKind::directional);
  CHECK(scene.lights[1].radiance == glm::vec3(1));
  check_near(scene.lights[1].direction, {0, -1, 0});
  CHECK(scene.lights[2].kind == LightKind::spot);
  CHECK(scene.lights[2].inner_angle == doctest::Approx(0.25 * 180 / std::numbers::pi));
  CHECK(scene.lights[2].outer_angle == doctest::Approx(0.5 * 180 / std::numbers::pi));
  CHECK(scene.lights[3].inner_angle == 0);
  CHECK(scene.lights[3].outer_angle == doctest::Approx(45));
  CHECK(scene.lights[4].inner_angle < scene.lights[4].outer_angle);
  CHECK(scene.lights[4].inner_angle == doctest::Approx(scene.lights[4].outer_angle).epsilon(0.002));

  file.json["extensions"]["KHR_lights_punctual"]["lights"][0]["range"] = 5;
  file.json["extensions"]["KHR_lights_punctual"]["lights"][1]["range"] = 6;
  CHECK(file.load().warnings.size() == 1);
}
