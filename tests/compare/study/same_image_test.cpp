// Every sampler and every option of the integrator is a way to the same image: compared tile by tile.

#include <vector>

#include <doctest/doctest.h>

#include "compare/statistics/bias_test.hpp"
#include "compare/study/sampling_study.hpp"
#include "compare/study/study_scenes.hpp"
#include "pathtracer/render/renderer.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

constexpr std::uint32_t side = 16, tile = 4;

/// Images under different seeds.
std::vector<pathtracer::Image> images(pathtracer::Renderer& renderer, const study::Method& method,
                                      std::uint32_t samples, std::uint32_t count, std::uint32_t first_seed) {
  pathtracer::RenderSettings settings{.width = side, .height = side, .max_depth = 5};
  settings.sampler = method.sampler;
  settings.planned_samples = samples;
  settings.light_sampling = method.light_sampling;
  settings.mis = method.mis;
  settings.bsdf_sampling = method.bsdf_sampling;
  settings.roulette = method.roulette;
  std::vector<pathtracer::Image> result;
  for (std::uint32_t i = 0; i < count; ++i) {
    settings.seed = first_seed + i;
    renderer.restart(settings);
    REQUIRE(renderer.render(samples));
    result.push_back(renderer.image());
  }
  return result;
}

double tiles_p_value(const std::vector<pathtracer::Image>& a, const std::vector<pathtracer::Image>& b) {
  return compare::test_bias(compare::batched(a, tile), compare::batched(b, tile)).tiles_p_value;
}

pathtracer::Renderer renderer_of(const rhi::DeviceHandle& device, const pathtracer::Scene& scene) {
  return {device, scene, {.width = side, .height = side}};
}

void check_same_image(const rhi::DeviceHandle& device, const pathtracer::Scene& scene, std::uint32_t samples) {
  constexpr std::uint32_t seeds = 8;
  pathtracer::Renderer renderer = renderer_of(device, scene);  // one: a device may take long to compile
  const std::vector<pathtracer::Image> expected = images(renderer, {}, samples, 2 * seeds, 1000);
  std::uint32_t seed = 0;
  for (const study::Method& method : study::methods()) {
    CAPTURE(method.name);
    // Fixed seeds, so that what passes cannot fail later; each p-value is corrected for its 64 tiles and channels, and
    // the smallest of some fifty methods, scenes and devices is expected at 0.02.
    CHECK(tiles_p_value(images(renderer, method, samples, seeds, seed), expected) > 1e-3);
    seed += seeds;
  }
}

}  // namespace

TANDEM_DEVICE_TEST("Every sampler and option converges to the same image of the Cornell box") {
  check_same_image(device_handle, study::weekend_box(), 32);
}

TANDEM_DEVICE_TEST("Every sampler and option converges to the same image of a light over a floor") {
  check_same_image(device_handle, study::light_over_floor(), 16);
}

TANDEM_DEVICE_TEST("An image that is darker by a few hundredths is found out") {
  const pathtracer::Scene scene = study::weekend_box();
  pathtracer::Scene darker = scene;
  for (pathtracer::GpuMaterial& material : darker.materials) material.emission *= 0.95f;
  pathtracer::Renderer bright = renderer_of(device_handle, scene);
  pathtracer::Renderer dark = renderer_of(device_handle, darker);
  CHECK(tiles_p_value(images(dark, {}, 64, 10, 0), images(bright, {}, 64, 20, 1000)) < 1e-4);
}
