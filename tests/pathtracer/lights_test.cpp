#include "pathtracer/lights.hpp"

#include <cmath>
#include <numeric>
#include <random>

#include <doctest/doctest.h>

using namespace tandem::pathtracer;

namespace {

/// Right triangles with legs of `leg` and the given emission, one each.
void add_light(Scene& scene, float leg, glm::vec3 emission) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), {{0, 0, 0}, {leg, 0, 0}, {0, leg, 0}});
  scene.normals.insert(scene.normals.end(), 3, glm::vec3(0, 0, 1));
  scene.triangles.push_back({{first, first + 1, first + 2}, static_cast<std::uint32_t>(scene.materials.size())});
  scene.materials.push_back(diffuse_material(glm::vec3(0), emission));
}

}  // namespace

TEST_CASE("The alias table gives each light the probability of its area times luminance") {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0.01f, 10.0f);
  for (const int count : {1, 2, 3, 17, 1000}) {
    Scene scene;
    std::vector<double> weights;
    for (int i = 0; i < count; ++i) {
      const float leg = uniform(random);
      const glm::vec3 emission(uniform(random), uniform(random), uniform(random));
      add_light(scene, leg, emission);
      weights.push_back(0.5 * double{leg} * double{leg} * luminance(emission));
    }
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    const std::vector<GpuLight> lights = build_lights(scene);
    const std::vector<double> probabilities = light_probabilities(lights);
    REQUIRE(lights.size() == static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < lights.size(); ++i) {
      CHECK(lights[i].primitive == i);
      CHECK(lights[i].alias < lights.size());
      // A light's probability is the sum of at most `count` thresholds, each cut to a multiple of 2^-32 / count.
      CHECK(std::abs(probabilities[i] - weights[i] / total) < 1e-9);
      const double area = triangle_area(scene, scene.triangles[i]);
      // One rounding to float.
      CHECK(lights[i].area_density == doctest::Approx(probabilities[i] / area).epsilon(1e-7));
    }
    CHECK(std::accumulate(probabilities.begin(), probabilities.end(), 0.0) == doctest::Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("Degenerate triangles and dark ones are no lights") {
  Scene scene;
  add_light(scene, 0, glm::vec3(5));
  add_light(scene, 1, glm::vec3(0));
  CHECK(build_lights(scene).empty());
  add_light(scene, 1, glm::vec3(0, 0, 2));
  const std::vector<GpuLight> lights = build_lights(scene);
  REQUIRE(lights.size() == 1);
  CHECK(lights[0].primitive == 2);
  CHECK(lights[0].alias == 0);
  CHECK(lights[0].area_density == doctest::Approx(2));
}
