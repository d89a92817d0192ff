#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/vec3.hpp>

#include "tests/shaders/test_scene.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using test::RenderConstants;

namespace {

/// A triangle that no ray of these tests meets, for scenes that are to be empty.
test::TestScene empty_scene() {
  test::TestScene scene;
  scene.add_quad({-1, -1, 1000}, {2, 0, 0}, {0, 2, 0}, scene.add_material(test::diffuse(glm::vec3(0))));
  return scene;
}

/// Mean over all pixels of one channel of the radiance.
double mean(const test::Rendering& rendering, std::uint32_t sample_count, std::size_t channel = 0) {
  double sum = 0.0;
  for (std::size_t i = channel; i < rendering.radiance_sum.size(); i += 3) sum += rendering.radiance_sum[i];
  return sum / (static_cast<double>(rendering.radiance_sum.size()) / 3.0 * sample_count);
}

/// A closed white room with a light under its ceiling and one wall of mirror, around the origin.
test::TestScene room() {
  test::TestScene scene;
  const std::uint32_t white = scene.add_material(test::diffuse(glm::vec3(0.7f, 0.6f, 0.5f)));
  const std::uint32_t light = scene.add_material(test::diffuse(glm::vec3(0.2f), glm::vec3(12, 10, 8)));
  const std::uint32_t shiny = scene.add_material(test::mirror(glm::vec3(0.9f, 0.8f, 0.7f)));
  const std::uint32_t clear = scene.add_material(test::glass(1.5f));
  scene.add_quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, white);
  scene.add_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);
  scene.add_quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, white);
  scene.add_quad({1, -1, 1}, {-2, 0, 0}, {0, 2, 0}, white);
  scene.add_quad({-1, -1, 1}, {0, 0, -2}, {0, 2, 0}, white);
  scene.add_quad({1, -1, -1}, {0, 0, 2}, {0, 2, 0}, shiny);
  scene.add_quad({-0.4f, 0.9f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, light);
  scene.add_quad({-0.6f, -0.8f, -0.3f}, {0.5f, 0, 0.1f}, {0, 0.6f, 0.1f}, clear);
  scene.add_lights();
  return scene;
}

}  // namespace

TANDEM_DEVICE_TEST("Rays that leave the scene bring the background, and are counted") {
  const test::TestScene scene = empty_scene();
  RenderConstants constants = test::render_constants(glm::vec3(0), 19, 11, scene);
  constants.background = {0.25f, 0.5f, 2.0f};
  constants.dispatch.sample_count = 4;
  const test::Rendering rendering = test::path_trace(device, test::upload(device, scene), {constants});
  for (std::size_t pixel = 0; pixel < 19 * 11; ++pixel) {
    REQUIRE(rendering.radiance_sum[3 * pixel] == 1.0f);
    REQUIRE(rendering.radiance_sum[3 * pixel + 1] == 2.0f);
    REQUIRE(rendering.radiance_sum[3 * pixel + 2] == 8.0f);
    REQUIRE(rendering.ray_counts[pixel] == 4);
  }
}

TANDEM_DEVICE_TEST("An emitter is seen from both sides, in the pixels that it covers") {
  // It covers the right half of the film: x from 0 on.
  test::TestScene scene;
  const std::uint32_t light = scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(3, 5, 7)));
  for (const float turn : {1.0f, -1.0f}) {
    test::TestScene turned = scene;
    if (turn > 0)
      turned.add_quad({0, -10, -5}, {10, 0, 0}, {0, 20, 0}, light);
    else
      turned.add_quad({0, -10, -5}, {0, 20, 0}, {10, 0, 0}, light);
    turned.add_lights();
    RenderConstants constants = test::render_constants(glm::vec3(0), 16, 8, turned);
    constants.max_depth = 1;
    const test::Rendering rendering = test::path_trace(device, test::upload(device, turned), {constants});
    for (std::size_t pixel = 0; pixel < 16 * 8; ++pixel) {
      const bool covered = pixel % 16 >= 8;
      REQUIRE(rendering.radiance_sum[3 * pixel] == (covered ? 3.0f : 0.0f));
      REQUIRE(rendering.radiance_sum[3 * pixel + 1] == (covered ? 5.0f : 0.0f));
      REQUIRE(rendering.radiance_sum[3 * pixel + 2] == (covered ? 7.0f : 0.0f));
      REQUIRE(rendering.ray_counts[pixel] == 1);
    }
  }
}

TANDEM_DEVICE_TEST("A mirror shows an emitter behind the camera, dimmed by its reflectance") {
  test::TestScene scene;
  scene.add_quad({-50, -50, -5}, {100, 0, 0}, {0, 100, 0}, scene.add_material(test::mirror({0.5f, 0.25f, 1.0f})));
  scene.add_quad({-500, -500, 5}, {1000, 0, 0}, {0, 1000, 0},
                 scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(4))));
  scene.add_lights();
  RenderConstants constants = test::render_constants(glm::vec3(0), 8, 8, scene);
  constants.max_depth = 2;
  const test::Rendering rendering = test::path_trace(device, test::upload(device, scene), {constants});
  for (std::size_t pixel = 0; pixel < 64; ++pixel) {
    REQUIRE(rendering.radiance_sum[3 * pixel] == 2.0f);
    REQUIRE(rendering.radiance_sum[3 * pixel + 1] == 1.0f);
    REQUIRE(rendering.radiance_sum[3 * pixel + 2] == 4.0f);
    REQUIRE(rendering.ray_counts[pixel] == 2);
  }
}

TANDEM_DEVICE_TEST("Under a uniform sky a diffuse plane has the radiance of its albedo, exactly") {
  test::TestScene scene;
  scene.add_quad({-50, -50, -5}, {100, 0, 0}, {0, 100, 0}, scene.add_material(test::diffuse({0.5f, 0.25f, 0.75f})));
  RenderConstants constants = test::render_constants(glm::vec3(0), 32, 32, scene);
  constants.background = glm::vec3(1);
  const test::Rendering rendering = test::path_trace(device, test::upload(device, scene), {constants});
  for (std::size_t pixel = 0; pixel < 32 * 32; ++pixel) {
    REQUIRE(rendering.radiance_sum[3 * pixel] == 0.5f);
    REQUIRE(rendering.radiance_sum[3 * pixel + 1] == 0.25f);
    REQUIRE(rendering.radiance_sum[3 * pixel + 2] == 0.75f);
    REQUIRE(rendering.ray_counts[pixel] == 2);
  }
}

TANDEM_DEVICE_TEST("Glass without absorption disappears under a uniform sky") {
  // A slab and a tilted block: what is not refracted is reflected, and the scaling of radiance inside cancels
  // outside.
  test::TestScene scene;
  const std::uint32_t clear = scene.add_material(test::glass(1.5f));
  scene.add_quad({-50, -50, -5}, {100, 0, 0}, {0, 100, 0}, clear);
  scene.add_quad({-50, -50, -6}, {0, 100, 0}, {100, 0, 0}, clear);
  RenderConstants constants = test::render_constants(glm::vec3(0), 64, 64, scene);
  constants.background = glm::vec3(1);
  constants.max_depth = 200;
  constants.dispatch.sample_count = 16;
  const test::Rendering rendering = test::path_trace(device, test::upload(device, scene), {constants});
  // Roulette is the only noise: few paths take more than three segments, and those survive at 95 % with weight 1 /
  // 0.95. The deviation of a sample is below sqrt(0.05), so five deviations of the mean of 65536 samples are 0.0044.
  CHECK(mean(rendering, 16) == doctest::Approx(1.0).epsilon(0.0045));
}

TANDEM_DEVICE_TEST("A rectangular light lights a diffuse plane as its form factor says") {
  // Straight above the point at which all pixels look (the camera's field of view is nearly nothing), parallel to the
  // plane.
  const double half = 0.5, height = 2.0;
  test::TestScene scene;
  scene.add_quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, scene.add_material(test::diffuse({0.5f, 0.25f, 1.0f})));
  scene.add_quad({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1},
                 scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(6, 3, 1))));
  scene.add_lights();
  RenderConstants constants = test::render_constants({1, 1, 0}, 64, 64, scene);
  constants.camera_forward = {-0.70710678f, -0.70710678f, 0};
  constants.camera_right = {0, 0, -1e-4f};
  constants.camera_up = {-0.70710678e-4f, 0.70710678e-4f, 0};
  constants.max_depth = 2;
  constants.dispatch.sample_count = 16;
  const test::Rendering rendering = test::path_trace(device, test::upload(device, scene), {constants});

  // Form factor of a point to a parallel rectangle over one of its corners, four times (Howell, configuration B-3).
  const double a = half / height;
  const double corner = 2.0 * a / std::sqrt(1 + a * a) * std::atan(a / std::sqrt(1 + a * a)) / (2.0 * std::numbers::pi);
  const double form_factor = 4.0 * corner;
  // The integrand varies by less than 15 % over the light, so five deviations of the mean of 65536 samples are below
  // 0.3
  // %.
  CHECK(mean(rendering, 16, 0) == doctest::Approx(0.5 * 6 * form_factor).epsilon(0.003));
  CHECK(mean(rendering, 16, 1) == doctest::Approx(0.25 * 3 * form_factor).epsilon(0.003));
  CHECK(mean(rendering, 16, 2) == doctest::Approx(1.0 * 1 * form_factor).epsilon(0.003));
}

TANDEM_DEVICE_TEST("Samples and tiles may be split over dispatches in any way without changing a bit") {
  const test::TestScene scene = room();
  const test::DeviceScene device_scene = test::upload(device, scene);
  RenderConstants constants = test::render_constants({0.1f, 0, 0.9f}, 37, 29, scene);
  constants.dispatch.sample_count = 6;
  const test::Rendering whole = test::path_trace(device, device_scene, {constants});

  std::vector<RenderConstants> split;
  for (const std::uint32_t y : {0u, 8u, 13u})
    for (const std::uint32_t x : {0u, 5u, 21u}) {
      RenderConstants part = constants;
      part.dispatch.tile_offset = {x, y};
      part.dispatch.tile_size = {(x == 0 ? 5u : x == 5 ? 16u : 16u), (y == 0 ? 8u : y == 8 ? 5u : 16u)};
      for (const std::uint32_t first : {0u, 1u, 4u}) {
        part.dispatch.first_sample = first;
        part.dispatch.sample_count = first == 0 ? 1 : first == 1 ? 3 : 2;
        split.push_back(part);
      }
    }
  const test::Rendering parts = test::path_trace(device, device_scene, split);
  CHECK(whole.radiance_sum == parts.radiance_sum);
  CHECK(whole.ray_counts == parts.ray_counts);
  CHECK(mean(whole, 6) > 0.1);
}

TANDEM_DEVICE_TEST(
    "Paths are no longer than max_depth, all finite, and another seed gives other paths of the same mean") {
  const test::TestScene scene = room();
  const test::DeviceScene device_scene = test::upload(device, scene);
  RenderConstants constants = test::render_constants({0.1f, 0, 0.9f}, 64, 64, scene);
  constants.dispatch.sample_count = 16;
  double previous = 0.0;
  for (const std::uint32_t depth : {1u, 2u, 4u, 16u}) {
    constants.max_depth = depth;
    const test::Rendering rendering = test::path_trace(device, device_scene, {constants});
    for (const float value : rendering.radiance_sum) REQUIRE((std::isfinite(value) && value >= 0.0f));
    // One ray for each segment and one to a light at each vertex but the last.
    for (const std::uint32_t count : rendering.ray_counts) REQUIRE((count >= 16 && count <= 16 * (2 * depth - 1)));
    CHECK(mean(rendering, 16) > previous);
    previous = mean(rendering, 16);
  }
  constants.seed = 2;
  const test::Rendering other = test::path_trace(device, device_scene, {constants});
  CHECK(mean(other, 16) != previous);
  // A sample deviates by a few times the mean; 65536 of them agree to a few percent.
  CHECK(mean(other, 16) == doctest::Approx(previous).epsilon(0.05));
}

TANDEM_DEVICE_TEST("A face that a scene holds twice looks like one, whichever copy a ray meets") {
  test::TestScene scene = room();
  RenderConstants constants = test::render_constants({0.1f, 0, 0.9f}, 64, 64, scene);
  constants.dispatch.sample_count = 4;
  const test::Rendering once = test::path_trace(device, test::upload(device, scene), {constants});
  for (const std::uint32_t quad : {0u, 3u, 5u, 7u}) {  // the floor, a wall, the mirror, the glass
    scene.triangles.push_back(scene.triangles[2 * quad]);
    scene.triangles.push_back(scene.triangles[2 * quad + 1]);
  }
  const test::Rendering twice = test::path_trace(device, test::upload(device, scene), {constants});
  std::size_t different = 0;
  for (std::size_t pixel = 0; pixel < once.ray_counts.size(); ++pixel)
    different +=
        !std::equal(&once.radiance_sum[3 * pixel], &once.radiance_sum[3 * pixel] + 3, &twice.radiance_sum[3 * pixel]);
  // Another tree may take the other triangle at an edge; 100,000 rays here do so a few times at most.
  CHECK(different <= 3);
}

TEST_CASE("All devices compute the same images to the last bit") {
  const test::NoWarnings no_warnings;
  const test::TestScene scene = room();
  RenderConstants constants = test::render_constants({0.1f, 0, 0.9f}, 128, 128, scene);
  constants.dispatch.sample_count = 4;
  std::vector<test::Rendering> renderings;
  for (const std::string& name : test::device_names()) {
    rhi::Device& device = *test::device(name);
    renderings.push_back(test::path_trace(device, test::upload(device, scene), {constants}));
  }
  for (const test::Rendering& rendering : renderings) {
    std::size_t different = 0;
    for (std::size_t pixel = 0; pixel < rendering.ray_counts.size(); ++pixel)
      different += !std::equal(&rendering.radiance_sum[3 * pixel], &rendering.radiance_sum[3 * pixel] + 3,
                               &renderings.front().radiance_sum[3 * pixel]);
    // A ray through a shared edge may hit either triangle; 500,000 rays here do so a few times at most.
    CHECK(different <= 3);
  }
}
