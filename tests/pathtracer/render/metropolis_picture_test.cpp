// Metropolis light transport: the same picture as path tracing in the limit, and the same bits whatever the order in
// which things are done. Seeds are fixed, so what passes cannot fail later.

#include "pathtracer/render/metropolis_picture.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "compare/statistics/bias_test.hpp"
#include "compare/study/study_scenes.hpp"
#include "devices/devices.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "pathtracer/render/renderer.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

constexpr std::uint32_t side = 16, tile = 4;

/// Small pictures have few mutations: few chains, so that each is long enough to show what is wrong with it.
RenderSettings metropolis_settings() {
  RenderSettings settings{.width = side, .height = side, .max_depth = 5};
  settings.integrator = Integrator::metropolis;
  settings.metropolis = {.chains = 128, .bootstrap_paths = 2048};
  return settings;
}

Scene door() { return load_scene(std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "scenes" / "door.json"); }

Image picture(const rhi::DeviceHandle& device, const Scene& scene, const RenderSettings& settings,
              std::uint32_t samples) {
  Renderer renderer(device, scene, settings);
  REQUIRE(renderer.render(samples));
  return renderer.image();
}

/// Under one seed each.
std::vector<Image> pictures(const Scene& scene, RenderSettings settings, std::uint32_t samples, std::uint32_t count,
                            std::uint32_t first_seed) {
  Renderer renderer(test::device("cpu"), scene, settings);
  std::vector<Image> result;
  for (std::uint32_t i = 0; i < count; ++i) {
    settings.seed = first_seed + i;
    renderer.restart(settings);
    REQUIRE(renderer.render(samples));
    result.push_back(renderer.image());
  }
  return result;
}

std::vector<Image> path_traced(const Scene& scene, RenderSettings settings, std::uint32_t samples,
                               std::uint32_t count) {
  settings.integrator = Integrator::path;
  return pictures(scene, settings, samples, count, 1000);
}

/// The smaller of the p-values of tiles and picture.
double p_value(const std::vector<Image>& a, const std::vector<Image>& b) {
  return compare::test_bias(compare::batched(a, tile), compare::batched(b, tile)).p_value;
}

bool same_bits(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)) == 0;
}

}  // namespace

TEST_CASE("Chains begin with bootstrap paths in proportion to their luminance") {
  // Half of the paths only scale; even chains get one of 1, 0, 3 and 4 eighths, odd ones one of 2, 2, 0 and 12.
  const std::vector<float> luminances = {1, 2, 3, 2, 2, 2, 2, 2, 1, 0, 3, 4, 2, 2, 0, 12};
  const MetropolisStart start = metropolis_start(luminances, 160, 7);
  CHECK(start.scale == 2);
  CHECK(start.brightness == std::array<double, 2>{2, 4});
  REQUIRE(start.paths.size() == 160);
  std::vector<int> counts(luminances.size());
  for (std::size_t chain = 0; chain < start.paths.size(); ++chain) {
    CHECK(start.paths[chain] / 4 == 2 + chain % 2);
    ++counts[start.paths[chain]];
  }
  // Equal steps hit an interval as often as its length says, but for one.
  const std::vector<int> expected = {0, 0, 0, 0, 0, 0, 0, 0, 10, 0, 30, 40, 10, 10, 0, 60};
  for (std::size_t path = 0; path < counts.size(); ++path) CHECK(std::abs(counts[path] - expected[path]) <= 1);
  for (const std::size_t dark : {9, 14}) CHECK(counts[dark] == 0);
}

TEST_CASE("Chains of a picture without light do not begin; those of a little light share it") {
  CHECK(metropolis_start(std::vector<float>(8, 0.0f), 4, 0).paths.empty());
  const MetropolisStart start = metropolis_start(std::vector<float>{0, 0, 0, 0, 0, 0, 0, 8}, 4, 0);
  CHECK(start.brightness == std::array<double, 2>{2, 2});
  CHECK(start.scale == 2);
  CHECK(start.paths == std::vector<std::uint32_t>(4, 7));
}

TEST_CASE("Metropolis and path tracing have the same image of the Cornell box") {
  const Scene scene = study::weekend_box();
  // The smallest of the p-values of four such tests is expected at 0.2; one of 1e-3 comes by chance once in 250 times.
  CHECK(p_value(pictures(scene, metropolis_settings(), 128, 12, 0),
                path_traced(scene, metropolis_settings(), 128, 24)) > 1e-3);
}

TEST_CASE("An image by Metropolis that is darker by a twentieth is found out") {
  const Scene scene = study::weekend_box();
  Scene darker = scene;
  for (GpuMaterial& material : darker.materials) material.emission *= 0.95f;
  CHECK(p_value(pictures(darker, metropolis_settings(), 256, 24, 0),
                path_traced(scene, metropolis_settings(), 256, 24)) < 1e-4);
}

TEST_CASE("Metropolis has no start-up bias: many pictures of few bootstrap paths have the right mean") {
  const Scene scene = study::weekend_box();
  RenderSettings settings = metropolis_settings();
  settings.metropolis = {.chains = 16, .bootstrap_paths = 64};
  CHECK(p_value(pictures(scene, settings, 2, 400, 0), path_traced(scene, settings, 128, 24)) > 1e-3);
}

TEST_CASE("Metropolis with large steps alone, and with few of them, has the same image") {
  const Scene scene = study::weekend_box();
  const std::vector<Image> expected = path_traced(scene, metropolis_settings(), 128, 24);
  for (const float probability : {1.0f, 0.05f}) {
    CAPTURE(probability);
    RenderSettings settings = metropolis_settings();
    settings.metropolis.large_step = probability;
    CHECK(p_value(pictures(scene, settings, 128, 12, 100), expected) > 1e-3);
  }
}

TEST_CASE("Metropolis and path tracing have the same image of a room behind a door") {
  const Scene scene = door();
  RenderSettings settings = metropolis_settings();
  settings.max_depth = 6;
  // One path in some hundreds finds the gap: with fewer, the brightness of most pictures would be too low, of few much
  // too high, and their mean far from normal.
  settings.metropolis.bootstrap_paths = 131072;
  CHECK(p_value(pictures(scene, settings, 128, 10, 0), path_traced(scene, settings, 512, 12)) > 1e-3);
}

TEST_CASE("How samples are spread over calls, dispatches and threads changes no bit of a Metropolis picture") {
  const Scene scene = study::weekend_box();
  RenderSettings settings = metropolis_settings();
  settings.width = 15;  // 240 pixels: calls end within a row of the 128 chains
  const Image expected = picture(test::device("cpu"), scene, settings, 6);
  Renderer renderer(test::device("cpu"), scene, settings);
  for (const std::uint32_t samples : {1, 3, 2}) REQUIRE(renderer.render(samples));
  CHECK(same_bits(renderer.image(), expected));
  // As many dispatches as there can be.
  settings.submission_seconds = 1e-9;
  CHECK(same_bits(picture(test::device("cpu"), scene, settings, 6), expected));
  CHECK(same_bits(picture(create_device({.name = "cpu", .thread_count = 1}), scene, settings, 6), expected));
  settings.seed = 1;
  CHECK_FALSE(same_bits(picture(test::device("cpu"), scene, settings, 6), expected));
}

TEST_CASE("A Metropolis picture that was cancelled is empty, and begins anew") {
  const Scene scene = study::weekend_box();
  Renderer renderer(test::device("cpu"), scene, metropolis_settings());
  CHECK_FALSE(renderer.render(64, [](double fraction) { return fraction < 0.5; }));
  CHECK(renderer.samples() == 0);
  CHECK(renderer.image().pixels.front() == glm::vec3(0));
  REQUIRE(renderer.render(2));
  CHECK(renderer.ray_count() > 0);
  CHECK(same_bits(renderer.image(), picture(test::device("cpu"), scene, metropolis_settings(), 2)));
}

TEST_CASE("A Metropolis picture without light is black") {
  Scene scene = study::weekend_box();
  for (GpuMaterial& material : scene.materials) material.emission = glm::vec3(0);
  RenderSettings settings = metropolis_settings();
  settings.background = glm::vec3(0);
  for (const glm::vec3& pixel : picture(test::device("cpu"), scene, settings, 2).pixels) CHECK(pixel == glm::vec3(0));
}

TANDEM_DEVICE_TEST("A Metropolis picture has the same bits on every device") {
  // Of a triangle over a floor: no ray comes near an edge that could be a tie.
  const Scene scene = study::light_over_floor();
  RenderSettings settings = metropolis_settings();
  settings.width = settings.height = 8;
  settings.max_depth = 3;
  settings.metropolis = {.chains = 64, .bootstrap_paths = 256};
  const Image expected = picture(test::device("cpu"), scene, settings, 8);
  CHECK(same_bits(picture(device_handle, scene, settings, 8), expected));
  CHECK(expected.pixels[27] != glm::vec3(0));
}
