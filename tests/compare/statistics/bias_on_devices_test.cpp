// The statistical tier on devices: no false alarm under other seeds, and a bias is found.

#include <filesystem>
#include <vector>

#include <doctest/doctest.h>

#include "compare/statistics/bias_test.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "pathtracer/render/renderer.hpp"
#include "tests/compare/statistics/noise.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

constexpr double level = 1e-4;

pathtracer::Scene cornell_box() {
  return pathtracer::load_scene(std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "scenes/cornell_box.obj", {});
}

pathtracer::Renderer renderer_of(const rhi::DeviceHandle& device, const pathtracer::RenderSettings& settings) {
  return {device, cornell_box(), settings};
}

/// Pictures under the seeds from `first_seed` on.
std::vector<pathtracer::Image> batches(pathtracer::Renderer& renderer, std::uint32_t first_seed, std::uint32_t count) {
  pathtracer::RenderSettings settings = renderer.scene().settings();
  std::vector<pathtracer::Image> pictures;
  for (std::uint32_t i = 0; i < count; ++i) {
    settings.seed = first_seed + i;
    renderer.restart(settings);
    REQUIRE(renderer.render(settings.planned_samples));
    pictures.push_back(renderer.image());
  }
  return pictures;
}

}  // namespace

TANDEM_DEVICE_TEST("A device under 50 other seeds is accepted 50 times") {
  constexpr std::uint32_t count = 8, tile = 8;
  pathtracer::Renderer renderer =
      renderer_of(device_handle, {.width = 16, .height = 16, .max_depth = 5, .planned_samples = 1});
  const compare::BatchedEstimate expected = compare::batched(batches(renderer, 0, count), tile);
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    CHECK(compare::test_bias(expected, compare::batched(batches(renderer, seed * count, count), tile)).p_value > level);
  }
}

TANDEM_DEVICE_TEST("A tile that is brighter by 2 % is found, where many samples leave little noise") {
  constexpr std::uint32_t count = 32, tile = 8;
  // Direct light alone, on the back wall above the blocks, which nothing shades.
  const pathtracer::Camera camera{.position = {278, 450, 100}, .target = {278, 430, 559}, .vertical_fov = 20};
  pathtracer::Renderer renderer =
      renderer_of(device_handle, {.width = 16, .height = 16, .max_depth = 2, .camera = camera, .planned_samples = 8});
  const compare::BatchedEstimate a = compare::batched(batches(renderer, 0, count), tile);
  const std::vector<pathtracer::Image> b = batches(renderer, 100, count);
  CHECK(compare::test_bias(a, compare::batched(b, tile)).p_value > level);
  const compare::Tile lower_left = a.tiles()[2];
  const compare::BiasTest biased = compare::test_bias(a, compare::batched(test::scaled(b, lower_left, 1.02), tile));
  CHECK(biased.p_value < level);
  CHECK(biased.worst_tile.tile.left == lower_left.left);
  CHECK(biased.worst_tile.tile.top == lower_left.top);
}
