#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.hpp"
#include "pathtracer/scene/merge.hpp"

using namespace tandem::pathtracer;

namespace {

/// One of everything, of a material that refers to a texture and a medium.
Scene model() {
  Scene scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0.6f, 0.8f}};
  scene.triangles = {{.vertices = {0, 1, 2}, .material = triangle_smooth}};
  scene.spheres = {{.centre = {1, 2, 3}, .radius = 2, .motion = {1, 0, 0}}};
  scene.materials = {diffuse_material(glm::vec3(0.5f))};
  scene.material_names = {"a"};
  add_texture(scene, {});
  scene.texture_coordinates = {{0, 0}, {1, 0}, {0, 1}};
  scene.materials[0].roughness_texture = 0;
  scene.materials[0].medium = 0;
  scene.media.push_back({.scattering = glm::vec3(1)});
  scene.lights.push_back({.kind = LightKind::spot, .position = {1, 0, 0}, .direction = {0, 1, 0}});
  scene.camera = Camera{.position = {0, 0, 5}};
  return scene;
}

}  // namespace

TEST_CASE("What is appended refers to its own materials, textures, images, media and vertices") {
  Scene scene = model();
  append(scene, model(), glm::dmat4(1.0));
  REQUIRE(scene.triangles.size() == 2);
  CHECK(scene.triangles[1].vertices[2] == 5);
  CHECK(scene.triangles[1].material == (1 | triangle_smooth));
  CHECK(scene.spheres[1].material == 1);
  CHECK(scene.materials[1].roughness_texture == 1);
  CHECK(scene.materials[1].alpha_texture == no_texture);
  CHECK(scene.materials[1].medium == 1);
  CHECK(scene.textures[1].image == 1);
  CHECK(scene.texture_coordinates.size() == 6);
}

TEST_CASE("Vertices without texture coordinates get some when others have them") {
  Scene plain = model();
  plain.texture_coordinates.clear();
  Scene scene = plain;
  append(scene, model(), glm::dmat4(1.0));
  append(scene, plain, glm::dmat4(1.0));
  REQUIRE(scene.texture_coordinates.size() == 9);
  CHECK(scene.texture_coordinates[1] == glm::vec2(0));
  CHECK(scene.texture_coordinates[4] == glm::vec2(1, 0));
}

TEST_CASE("A transform moves spheres, lights and the camera, and keeps the outside of triangles where it mirrors") {
  Scene scene;
  glm::dmat4 transform = glm::translate(glm::dmat4(1.0), glm::dvec3(10, 0, 0));
  transform = glm::scale(transform, glm::dvec3(-2, 2, 2));
  append(scene, model(), transform);
  CHECK(scene.spheres[0].centre == glm::vec3(8, 4, 6));
  CHECK(scene.spheres[0].radius == doctest::Approx(4));
  CHECK(scene.spheres[0].motion == glm::vec3(-2, 0, 0));
  CHECK(scene.lights[0].position == glm::vec3(8, 0, 0));
  CHECK(scene.lights[0].direction == glm::vec3(0, 1, 0));
  CHECK(scene.camera->position == glm::vec3(10, 0, 10));
  // It looked at +z with its vertices (0, 0), (1, 0), (0, 1); mirrored in x they come the other way round.
  CHECK(scene.triangles[0].vertices[1] == 2);
  CHECK(scene.triangles[0].vertices[2] == 1);
  CHECK(scene.normals[0] == glm::vec3(0, 0, 1));

  append(scene, model(), glm::dmat4(1.0));
  CHECK(scene.camera->position == glm::vec3(10, 0, 10));  // the first one counts
}

TEST_CASE("Spheres stay spheres, and positions floats") {
  Scene scene;
  CHECK_THROWS_AS(append(scene, model(), glm::scale(glm::dmat4(1.0), glm::dvec3(1, 2, 1))), tandem::Error);
  CHECK_THROWS_AS(append(scene, model(), glm::scale(glm::dmat4(1.0), glm::dvec3(1e13))), tandem::Error);
}
