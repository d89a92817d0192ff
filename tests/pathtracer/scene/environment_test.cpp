#include "pathtracer/scene/environment.hpp"

#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "pathtracer/scene/lights.hpp"

using namespace tandem::pathtracer;

namespace {

constexpr double pi = std::numbers::pi;

/// A scene with a map of these grey levels, row by row from the top.
Scene scene_with_map(std::uint32_t width, std::uint32_t height, const std::vector<float>& levels,
                     TextureFilter filter) {
  Scene scene;
  scene.name = "test";
  TextureImage image{.name = "map", .format = TexelFormat::float32, .width = width, .height = height, .texels = {}};
  std::vector<float> values;
  for (const float level : levels) values.insert(values.end(), {level, level, level, 1.0f});
  image.texels.resize(values.size() * sizeof(float));
  std::memcpy(image.texels.data(), values.data(), image.texels.size());
  scene.environment = Environment{.texture = add_texture(scene, image), .radiance = glm::vec3(1)};
  scene.textures.back().gpu.filter = filter;
  return scene;
}

}  // namespace

TEST_CASE("A constant environment is one cell, uniform over the sphere") {
  Scene scene;
  CHECK(environment_cells(scene).empty());
  CHECK(environment_luminance(scene) == 0);
  scene.environment = Environment{.radiance = glm::vec3(3)};
  const std::vector<GpuEnvironmentCell> cells = environment_cells(scene);
  REQUIRE(cells.size() == 1);
  CHECK(cells[0].alias == 0);
  CHECK(cells[0].density == doctest::Approx(1 / (4 * pi)).epsilon(1e-7));
  CHECK(environment_luminance(scene) == doctest::Approx(12 * pi).epsilon(1e-12));
  scene.environment->radiance = glm::vec3(0);
  CHECK(environment_cells(scene).empty());
}

TEST_CASE("The densities of a map's cells integrate to 1 and follow its luminance") {
  for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::linear}) {
    std::vector<float> levels;
    for (int i = 0; i < 8 * 4; ++i) levels.push_back(static_cast<float>(i % 5 == 0 ? 0 : 1 + i % 7));
    const Scene scene = scene_with_map(8, 4, levels, filter);
    const std::vector<GpuEnvironmentCell> cells = environment_cells(scene);
    REQUIRE(cells.size() == levels.size());
    const double all = environment_luminance(scene);
    double sum = 0;
    double luminance_sum = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double row = double(i / 8);
      const double solid_angle = 2 * pi / 8 * (std::cos(pi * row / 4) - std::cos(pi * (row + 1) / 4));
      sum += cells[i].density * solid_angle;
      luminance_sum += double{levels[i]} * solid_angle;
      // Thresholds are multiples of 2^-32, densities floats.
      if (filter == TextureFilter::nearest)
        CHECK(cells[i].density == doctest::Approx(double{levels[i]} / all).epsilon(1e-6));
      else
        CHECK(cells[i].density > 0);  // next to every 0 there is light
    }
    CHECK(sum == doctest::Approx(1).epsilon(1e-6));
    // Filtering moves light between rows of unequal solid angle; without it nothing changes.
    if (filter == TextureFilter::nearest) CHECK(all == doctest::Approx(luminance_sum).epsilon(1e-9));
  }
}

TEST_CASE("A linear filter spreads one texel over its neighbours, around the back but not over the poles") {
  std::vector<float> levels(8 * 4, 0.0f);
  levels[0] = 1;  // upper left
  const std::vector<GpuEnvironmentCell> cells = environment_cells(scene_with_map(8, 4, levels, TextureFilter::linear));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t column = i % 8, row = i / 8;
    CHECK((cells[i].density > 0) == (row <= 1 && (column <= 1 || column == 7)));
  }
  // 3/4 across; 7/8 down, because the pole has the colour of its row.
  CHECK(cells[1].density / cells[0].density == doctest::Approx(0.125 / 0.75).epsilon(1e-6));
  CHECK(cells[7].density == cells[1].density);
  CHECK(cells[8].density / cells[0].density == doctest::Approx(0.125 / 0.875).epsilon(1e-6));
}

TEST_CASE("An environment must be a whole image") {
  Scene scene = scene_with_map(2, 1, {1, 1}, TextureFilter::linear);
  scene.textures[0].gpu.u_row = {2, 0, 0};
  CHECK_THROWS_WITH_AS(environment_cells(scene), "the environment of test is not a whole image", tandem::Error);
  scene.textures[0].gpu = {.kind = TextureKind::checker};
  CHECK_THROWS_WITH_AS(environment_luminance(scene), "the environment of test is not a whole image", tandem::Error);
}

TEST_CASE("A rotation turns the map counter-clockwise seen from above") {
  RenderConstants constants;
  set_environment_frame(constants, {.rotation = 0});
  CHECK(constants.environment_right == glm::vec3(1, 0, 0));
  CHECK(constants.environment_up == glm::vec3(0, 1, 0));
  CHECK(constants.environment_forward == glm::vec3(0, 0, -1));
  set_environment_frame(constants, {.rotation = 90});
  // From above, with -z upwards and +x to the right, counter-clockwise leads from -z to -x.
  CHECK(glm::distance(constants.environment_forward, glm::vec3(-1, 0, 0)) < 1e-7f);
  CHECK(glm::distance(constants.environment_right, glm::vec3(0, 0, -1)) < 1e-7f);
}
