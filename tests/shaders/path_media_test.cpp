#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "base/statistics/means.hpp"
#include "pathtracer/render/features.hpp"
#include "tests/shaders/function_kernel.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/shaders/test_scene.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/statistics/chi_square.hpp"

using namespace tandem;
using test::RenderConstants;
namespace feature = pathtracer::feature;

namespace {

constexpr std::uint32_t media_features = feature::media | feature::options;

pathtracer::GpuMaterial boundary(std::uint32_t medium) {
  pathtracer::GpuMaterial material = test::diffuse(glm::vec3(0));
  material.model = pathtracer::MaterialModel::boundary;
  material.medium = medium;
  return material;
}

/// A camera whose pixels all look along -z.
RenderConstants narrow(const glm::vec3& position, const test::TestScene& scene) {
  RenderConstants constants = test::render_constants(position, 32, 32, scene);
  constants.camera_right = {1e-4f, 0, 0};
  constants.camera_up = {0, 1e-4f, 0};
  return constants;
}

statistics::Mean mean_of_pixels(const test::Rendering& rendering, std::size_t channel, std::uint32_t sample_count) {
  std::vector<double> samples;
  for (std::size_t i = channel; i < rendering.radiance_sum.size(); i += 3)
    samples.push_back(static_cast<double>(rendering.radiance_sum[i]) / sample_count);
  return statistics::mean_of(samples);
}

}  // namespace

TANDEM_DEVICE_TEST(
    "Light through an absorbing medium falls off exponentially, around everything and behind boundaries") {
  const glm::vec3 absorption{0.1f, 0.5f, 2.0f};
  test::TestScene scene;
  scene.media.push_back({.absorption = absorption});
  scene.add_quad({-50, -50, -5}, {100, 0, 0}, {0, 100, 0},
                 scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(4))));
  const rhi::ComputePipelineHandle pipeline = test::path_trace_pipeline(device, media_features);
  const auto check = [&](const test::TestScene& tested, const RenderConstants& constants, double length,
                         std::uint32_t rays) {
    const test::Rendering rendering = test::path_trace(device, pipeline, test::upload(device, tested), {constants});
    for (std::size_t pixel = 0; pixel < rendering.ray_counts.size(); ++pixel) {
      REQUIRE(rendering.ray_counts[pixel] == rays);
      for (int c = 0; c < 3; ++c) {
        // The view is 2e-4 wide, and an exponential of up to -10 magnifies the rounding of its argument ten times.
        const double exact = 4 * std::exp(-static_cast<double>(absorption[c]) * length);
        REQUIRE(rendering.radiance_sum[3 * pixel + static_cast<std::size_t>(c)] ==
                doctest::Approx(exact).epsilon(1e-5));
      }
    }
  };
  RenderConstants constants = narrow(glm::vec3(0), scene);
  constants.max_depth = 1;
  constants.medium = 0;
  check(scene, constants, 5.0, 1);
  // Boundaries add no depth: two of them are crossed by a path of one segment.
  constants.medium = pathtracer::no_medium;
  check(scene, constants, 0.0, 1);
  test::TestScene box = scene;
  box.add_box({-1, -1, -3.5f}, {1, 1, -2}, box.add_material(boundary(0)));
  check(box, constants, 1.5, 3);
  // Clear inside, the medium around.
  test::TestScene bubble = scene;
  bubble.add_box({-1, -1, -3.5f}, {1, 1, -2}, bubble.add_material(boundary(pathtracer::no_medium)));
  constants.medium = 0;
  check(bubble, constants, 3.5, 3);
}

TANDEM_DEVICE_TEST("Shadow rays go through boundaries and lose what their medium absorbs") {
  // A small light far above a floor, and a slab of the medium between them; the ratio to the same scene without
  // absorption is the transmittance, since all else is the same. The light is 0.02 wide at 10 units: no ray is longer
  // within the slab by more than 1e-5, where it is not scattered into the light, which happens to one in 10^6.
  test::TestScene scene;
  scene.media.resize(1);
  scene.add_quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, scene.add_material(test::diffuse(glm::vec3(0.5f))));
  scene.add_quad({-0.01f, 10, -0.01f}, {0.02f, 0, 0}, {0, 0, 0.02f},
                 scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(1e5f))));
  scene.add_lights();
  scene.add_box({-20, 2, -20}, {20, 3, 20}, scene.add_material(boundary(0)));
  RenderConstants constants = narrow({1, 1, 0}, scene);
  constants.camera_forward = {-0.70710678f, -0.70710678f, 0};
  constants.camera_right = {0, 0, -1e-4f};
  constants.camera_up = {-0.70710678e-4f, 0.70710678e-4f, 0};
  constants.max_depth = 2;
  const rhi::ComputePipelineHandle pipeline = test::path_trace_pipeline(device, media_features);
  const test::Rendering clear = test::path_trace(device, pipeline, test::upload(device, scene), {constants});
  scene.media[0].absorption = {0.25f, 1.0f, 3.0f};
  const test::Rendering absorbed = test::path_trace(device, pipeline, test::upload(device, scene), {constants});
  for (std::size_t c = 0; c < 3; ++c) {
    const double ratio = mean_of_pixels(absorbed, c, 1).value / mean_of_pixels(clear, c, 1).value;
    CHECK(
        ratio ==
        doctest::Approx(std::exp(-static_cast<double>(scene.media[0].absorption[static_cast<int>(c)]))).epsilon(1e-4));
  }
  // Around everything too: light from the emitter travels 10 units, light to the camera sqrt(2).
  constants.medium = 0;
  const test::Rendering around = test::path_trace(device, pipeline, test::upload(device, scene), {constants});
  const double ratio = mean_of_pixels(around, 0, 1).value / mean_of_pixels(clear, 0, 1).value;
  CHECK(ratio == doctest::Approx(std::exp(-0.25 * (10 + std::sqrt(2.0)))).epsilon(1e-3));
}

TANDEM_DEVICE_TEST("A medium that only scatters is invisible under a uniform sky, in every colour") {
  test::TestScene scene;
  scene.media.push_back({.anisotropy = 0.5f, .scattering = {0.2f, 1.0f, 2.0f}});
  scene.add_box({-1, -1, -3}, {1, 1, -1}, scene.add_material(boundary(0)));
  const rhi::ComputePipelineHandle pipeline = test::path_trace_pipeline(device, media_features);
  RenderConstants constants = narrow(glm::vec3(0), scene);
  constants.background = glm::vec3(1);
  constants.max_depth = 1000;
  constants.dispatch.sample_count = 16;
  for (const float anisotropy : {0.5f, -0.7f, 0.0f}) {
    scene.media[0].anisotropy = anisotropy;
    const test::Rendering rendering = test::path_trace(device, pipeline, test::upload(device, scene), {constants});
    for (std::size_t c = 0; c < 3; ++c) {
      const statistics::Mean mean = mean_of_pixels(rendering, c, 16);
      // Nine independent tests at five deviations: one seed in 200,000 fails.
      CHECK(std::abs(statistics::z_score(mean, 1.0)) < 5);
      CHECK(mean.standard_error < 0.05);
    }
  }
}

TANDEM_DEVICE_TEST("Light scattered once is the integral over the ray, by every technique") {
  // A light fills half of all directions, so what an isotropic medium scatters once along a ray of length 2 is half of
  // 1 - exp(-2 sigma) of the light's radiance, but for what is lost on the way to the light: sigma is 0.01, the way
  // below 2 on average.
  test::TestScene scene;
  scene.media.push_back({.scattering = glm::vec3(0.01f)});
  scene.add_box({-1, -1, -3}, {1, 1, -1}, scene.add_material(boundary(0)));
  scene.add_quad({-1000, 3, -1000}, {2000, 0, 0}, {0, 0, 2000},
                 scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(100))));
  scene.add_lights();
  RenderConstants constants = narrow(glm::vec3(0), scene);
  constants.max_depth = 2;
  constants.dispatch.sample_count = 64;
  const rhi::ComputePipelineHandle pipeline = test::path_trace_pipeline(device, media_features);
  const test::DeviceScene device_scene = test::upload(device, scene);
  const double truth = 0.5 * (1 - std::exp(-0.02)) * 100;
  for (const std::uint32_t light_sampling : {1u, 0u}) {
    constants.light_sampling = light_sampling;
    ++constants.seed;
    const statistics::Mean mean = mean_of_pixels(test::path_trace(device, pipeline, device_scene, {constants}), 0, 64);
    CAPTURE(mean.value);
    CHECK(std::abs(mean.value - truth) < 5 * mean.standard_error + 0.02 * truth);
    CHECK(mean.standard_error < 0.05 * truth);
  }
}

TANDEM_DEVICE_TEST("All techniques light a thick medium around an emitter in a box alike") {
  test::TestScene scene;
  scene.media.push_back({.absorption = {0.3f, 0.1f, 0.0f}, .anisotropy = 0.6f, .scattering = {1.0f, 0.5f, 2.0f}});
  const std::uint32_t white = scene.add_material(test::diffuse(glm::vec3(0.5f)));
  scene.add_box({-2, -2, -6}, {2, 2, 2}, white);
  scene.add_quad({-1, 1.9f, -4}, {2, 0, 0}, {0, 0, 2}, scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(5))));
  scene.add_lights();
  scene.add_box({-1.5f, -1.5f, -5}, {1.5f, 1.5f, -1.5f}, scene.add_material(boundary(0)));
  RenderConstants constants = test::render_constants(glm::vec3(0), 48, 48, scene);
  constants.dispatch.sample_count = 16;
  constants.max_depth = 6;
  const rhi::ComputePipelineHandle pipeline = test::path_trace_pipeline(device, media_features);
  const test::DeviceScene device_scene = test::upload(device, scene);
  const test::Rendering usual = test::path_trace(device, pipeline, device_scene, {constants});
  for (const bool sampling : {true, false}) {
    RenderConstants other = constants;
    ++other.seed;
    if (sampling)
      other.mis = pathtracer::Mis::none;
    else
      other.light_sampling = 0;
    const test::Rendering rendering = test::path_trace(device, pipeline, device_scene, {other});
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(statistics::welch_p_value(mean_of_pixels(usual, c, 16), mean_of_pixels(rendering, c, 16)) > 1e-5);
  }
}

TANDEM_DEVICE_TEST("Henyey and Greenstein's phase function is sampled with its density, which integrates to 1") {
  constexpr std::size_t count = 40000;
  const test::SphereBins bins;
  for (const float anisotropy : {0.0f, 0.3f, -0.8f, 0.7f}) {
    CAPTURE(anisotropy);
    test::RandomSource random(7);
    std::vector<float> inputs;
    for (std::size_t i = 0; i < count; ++i)
      for (int k = 0; k < 2; ++k) inputs.push_back(static_cast<float>(random.bits() >> 8) * 0x1p-24f);
    const std::string g = "float(" + std::to_string(anisotropy) + ")";
    const std::vector<float> directions =
        test::run(device,
                  {.includes = "#include \"integrator/phase_function.glsl\"",
                   .body = "vec3 wi = sample_phase(" + g + ", vec2(input_float(0), input_float(1)));" +
                           "output_float(0, wi.x); output_float(1, wi.y); output_float(2, wi.z);",
                   .input_count = 2,
                   .output_count = 3},
                  inputs);
    std::vector<double> counts(bins.count());
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec3 wi(directions[3 * i], directions[3 * i + 1], directions[3 * i + 2]);
      // Rounding of a square root and of two products.
      REQUIRE(std::abs(glm::dot(wi, wi) - 1.0) < 1e-6);
      ++counts[bins.bin(wi)];
    }
    std::vector<float> cosines;
    for (const glm::dvec3& node : bins.nodes(8)) cosines.push_back(static_cast<float>(node.z));
    const std::vector<float> values = test::run(device,
                                                {.includes = "#include \"integrator/phase_function.glsl\"",
                                                 .body = "output_float(0, phase_density(" + g + ", input_float(0)));"},
                                                cosines);
    const std::vector<double> densities(values.begin(), values.end());
    const std::vector<double> expected = bins.integrals(densities);
    double whole = 0;
    for (const double value : expected) whole += value;
    // The midpoint rule over 128 heights; at -0.8 the peak is a few of them wide.
    CHECK(whole == doctest::Approx(1.0).epsilon(0.01));
    CHECK(test::chi_square(counts, expected).p_value > 1e-4);
  }
}
