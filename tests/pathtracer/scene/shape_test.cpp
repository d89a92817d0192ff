#include "pathtracer/scene/shape.hpp"

#include <doctest/doctest.h>

#include "pathtracer/scene/camera.hpp"

using namespace tandem::pathtracer;

namespace {

/// Squares from -1 to 1 in x and y, one above the other in z from -1 to 1.
Scene stack_of_squares(std::uint32_t count) {
  Scene scene;
  scene.materials.push_back(diffuse_material(glm::vec3(0.5f)));
  scene.material_names.emplace_back("grey");
  for (std::uint32_t i = 0; i < count; ++i) {
    const float z = -1 + 2 * static_cast<float>(i) / static_cast<float>(count - 1);
    for (const glm::vec2 p : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
      scene.positions.emplace_back(p, z);
      scene.normals.emplace_back(0, 0, 1);
    }
    scene.triangles.push_back({.vertices = {4 * i, 4 * i + 1, 4 * i + 2}, .material = 0});
    scene.triangles.push_back({.vertices = {4 * i, 4 * i + 2, 4 * i + 3}, .material = 0});
  }
  return scene;
}

}  // namespace

TEST_CASE("Lines along an axis meet what they pass through") {
  const SceneProbe probe(stack_of_squares(3));
  CHECK(probe.resolution() == 24);
  for (const std::size_t i : {0u, 12u, 23u}) {
    const std::vector<LineHit>& hits = probe.line(2, i, 23 - i / 2);
    REQUIRE(hits.size() >= 3);  // the two triangles of a square share the lines on their diagonal
    CHECK(hits.front().coordinate == -1);
    CHECK(hits.back().coordinate == 1);
    CHECK(hits.front().faces_upwards);
  }
  CHECK(probe.closed_fraction(2, true) == 1);
  CHECK(probe.closed_fraction(0, true) == 0);
}

TEST_CASE("Where triangles are many and large, lines are few, so that what they meet stays within bounds") {
  constexpr std::uint32_t count = 1000;
  const Scene scene = stack_of_squares(count);
  // Each of the 2000 triangles may meet 24 x 24 lines along z.
  for (const auto& [most, resolution] :
       {std::pair{2000u * 576, 24u}, {2000u * 576 - 1, 12u}, {2000u * 144 - 1, 6u}, {2000u * 36 - 1, 3u}, {1u, 3u}}) {
    const SceneProbe probe(scene, most);
    CHECK(probe.resolution() == resolution);
    // Each line is complete.
    CHECK(probe.line(2, 0, 1).size() == count);
    CHECK(probe.closed_fraction(2, false) == 1);
  }
  // Of 200,000 triangles the lines of the finest grid meet 29 million, which would be the usual bound's double.
  CHECK(SceneProbe(stack_of_squares(100000)).resolution() < 24);
}

TEST_CASE("A camera is found with few lines as with many") {
  const Scene scene = stack_of_squares(50000);
  const Camera camera = automatic_camera(scene, 1);
  const Camera expected = automatic_camera(stack_of_squares(1000), 1);
  for (int axis = 0; axis < 3; ++axis)
    CHECK(camera.position[axis] == doctest::Approx(expected.position[axis]).epsilon(1e-4));
}
