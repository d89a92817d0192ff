#include "pathtracer/scene/lights.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include "base/error.hpp"

using namespace tandem::pathtracer;

namespace {

constexpr double pi = std::numbers::pi;

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

TEST_CASE("Lights of all kinds share the table by their powers") {
  Scene scene;
  scene.name = "test";
  add_light(scene, 2, glm::vec3(5));     // area 2
  scene.positions.push_back({9, 9, 9});  // that no triangle uses
  scene.materials.push_back(diffuse_material(glm::vec3(0), glm::vec3(3)));
  scene.spheres.push_back({.centre = {1, 1, 1}, .radius = 0.5f, .material = 1});
  scene.spheres.push_back({.centre = {1, 1, 1}, .radius = 0.5f, .material = 0});
  scene.environment = Environment{.radiance = glm::vec3(0.25f)};
  scene.lights.push_back({.kind = LightKind::point, .position = {0, 1, 0}, .radiance = glm::vec3(7)});
  scene.lights.push_back({.kind = LightKind::point, .radiance = glm::vec3(0)});  // dark: no light
  scene.lights.push_back({.kind = LightKind::spot,
                          .direction = {0, -3, 0},
                          .radiance = glm::vec3(10),
                          .inner_angle = 20,
                          .outer_angle = 30});
  scene.lights.push_back({.kind = LightKind::directional, .direction = {0, 3, 4}, .radiance = glm::vec3(2)});

  // The bounds are (0, 0, 0) to (2, 2, 1.5).
  const double squared_radius = (4 + 4 + 2.25) / 4;
  // The falloff of the spot light, integrated in steps.
  const double inner = std::cos(pi / 9), outer = std::cos(pi / 6);
  double falloff = 0;
  constexpr int steps = 100000;
  for (int i = 0; i < steps; ++i) {
    const double ramp = (i + 0.5) / steps;
    falloff += ramp * ramp * (inner - outer) / steps;
  }
  const std::vector<double> powers = {pi * 2 * 5,
                                      pi * 4 * pi * 0.25 * 3,
                                      pi * 4 * pi * 0.25 * 5,
                                      pi * squared_radius * 4 * pi * 0.25,
                                      4 * pi * 7,
                                      2 * pi * 10 * (1 - inner + falloff),
                                      pi * squared_radius * 2};
  const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
  const std::vector<GpuLight> lights = build_lights(scene);
  REQUIRE(lights.size() == powers.size());
  const std::vector<double> probabilities = light_probabilities(lights);
  for (std::size_t i = 0; i < powers.size(); ++i) {
    CHECK(probabilities[i] == doctest::Approx(powers[i] / total).epsilon(1e-7));
    CHECK(lights[i].probability == doctest::Approx(probabilities[i]).epsilon(1e-7));
  }
  const LightKind kinds[] = {LightKind::triangle, LightKind::sphere, LightKind::sphere,     LightKind::environment,
                             LightKind::point,    LightKind::spot,   LightKind::directional};
  for (std::size_t i = 0; i < powers.size(); ++i) CHECK(lights[i].kind == kinds[i]);
  CHECK(lights[1].primitive == 1);
  CHECK(lights[2].primitive == 2);
  CHECK(lights[1].area_density == doctest::Approx(probabilities[1] / pi).epsilon(1e-6));
  CHECK(lights[4].position == glm::vec3(0, 1, 0));
  CHECK(lights[5].direction == glm::vec3(0, -1, 0));
  CHECK(lights[5].cosine_inner == doctest::Approx(inner));
  CHECK(lights[5].cosine_outer == doctest::Approx(outer));
  CHECK(lights[6].direction == glm::vec3(0, 0.6f, 0.8f));
  CHECK(lights[6].radiance == glm::vec3(2));
}

TEST_CASE("A textured emitter is chosen by the mean of its texture") {
  Scene scene;
  add_light(scene, 1, glm::vec3(8));
  add_light(scene, 1, glm::vec3(1));
  TextureImage image{.name = "test", .format = TexelFormat::unorm8, .width = 2, .height = 1, .texels = {}};
  for (const int value : {51, 51, 51, 255, 0, 0, 0, 255}) image.texels.push_back(std::byte(value));
  scene.materials[0].emission_texture = add_texture(scene, image);
  std::vector<GpuLight> lights = build_lights(scene);
  REQUIRE(lights.size() == 2);
  // 8 * (0.2 + 0) / 2 against 1.
  CHECK(lights[0].probability == doctest::Approx(0.8 / 1.8).epsilon(1e-6));
  scene.images[0].texels.assign(8, std::byte{0});
  lights = build_lights(scene);
  REQUIRE(lights.size() == 1);
  CHECK(lights[0].primitive == 1);
}

TEST_CASE("Numbers of a light that make no sense are refused, naming the light") {
  Scene scene;
  scene.name = "hall.json";
  add_light(scene, 1, glm::vec3(1));
  const auto refused = [&](const PunctualLight& light, const std::string& message) {
    scene.lights = {{.radiance = glm::vec3(1)}, light};
    CHECK_THROWS_WITH_AS(build_lights(scene), ("light 1 of hall.json: " + message).c_str(), tandem::Error);
  };
  refused({.radiance = glm::vec3(-1)}, "its intensity is not finite and at least 0");
  refused({.position = glm::vec3(std::nanf("")), .radiance = glm::vec3(1)}, "its position is not finite");
  refused({.kind = LightKind::directional, .direction = glm::vec3(0), .radiance = glm::vec3(1)},
          "its direction is zero or not finite");
  refused({.kind = LightKind::spot, .radiance = glm::vec3(1), .inner_angle = 40, .outer_angle = 30},
          "the angles of a spot light, 40 and 30 degrees, are not ascending from 0 to 90");
  refused({.kind = LightKind::sphere, .radiance = glm::vec3(1)}, "it has an extent");
}
