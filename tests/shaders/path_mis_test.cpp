#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "base/statistics/means.hpp"
#include "pathtracer/render/features.hpp"
#include "tests/shaders/test_scene.hpp"
#include "tests/support/device_test.hpp"

// All ways to estimate the same light agree in the mean. Seeds are fixed; a test that is right would fail under one
// seed in 10^5. Pixels of a picture are independent but not alike, which only makes the errors look larger than they
// are.

using namespace tandem;
using pathtracer::BsdfSampling;
using pathtracer::MaterialModel;
using pathtracer::Mis;
using test::RenderConstants;
namespace feature = pathtracer::feature;

namespace {

constexpr double unlikely = 1e-5;
constexpr std::uint32_t sample_count = 16;

/// One colour of every pixel.
statistics::Mean mean_of_pixels(const test::Rendering& rendering, std::size_t channel) {
  std::vector<double> samples;
  for (std::size_t i = channel; i < rendering.radiance_sum.size(); i += 3)
    samples.push_back(static_cast<double>(rendering.radiance_sum[i]) / sample_count);
  return statistics::mean_of(samples);
}

struct Technique {
  std::string name;
  std::function<void(RenderConstants&)> set;
};

const std::vector<Technique> techniques = {
    {"no multiple importance sampling", [](RenderConstants& c) { c.mis = Mis::none; }},
    {"balance heuristic", [](RenderConstants& c) { c.mis = Mis::balance; }},
    {"no next event estimation", [](RenderConstants& c) { c.light_sampling = 0; }},
    {"cosine", [](RenderConstants& c) { c.bsdf_sampling = BsdfSampling::cosine; }},
    {"uniform", [](RenderConstants& c) { c.bsdf_sampling = BsdfSampling::uniform; }},
    {"uniform without next event estimation",
     [](RenderConstants& c) {
       c.bsdf_sampling = BsdfSampling::uniform;
       c.light_sampling = 0;
     }},
    {"cosine without multiple importance sampling",
     [](RenderConstants& c) {
       c.bsdf_sampling = BsdfSampling::cosine;
       c.mis = Mis::none;
     }},
    {"no roulette", [](RenderConstants& c) { c.roulette = 0; }},
};

/// Every technique against the defaults. Returns the errors of the means, those of the defaults first.
std::vector<double> compare_techniques(rhi::Device& device, std::uint32_t features, const test::TestScene& scene,
                                       RenderConstants constants) {
  constants.dispatch.sample_count = sample_count;
  const rhi::ComputePipelineHandle pipeline = test::path_trace_pipeline(device, features | feature::options);
  const test::DeviceScene device_scene = test::upload(device, scene);
  const test::Rendering usual = test::path_trace(device, pipeline, device_scene, {constants});
  std::vector<double> errors = {mean_of_pixels(usual, 0).standard_error};
  std::uint32_t seed = 100;
  for (const Technique& technique : techniques) {
    CAPTURE(technique.name);
    RenderConstants other = constants;
    other.seed = ++seed;
    technique.set(other);
    const test::Rendering rendering = test::path_trace(device, pipeline, device_scene, {other});
    for (const std::size_t channel : {0, 2}) {
      const statistics::Mean a = mean_of_pixels(usual, channel), b = mean_of_pixels(rendering, channel);
      CAPTURE(a.value);
      CAPTURE(b.value);
      CHECK(a.value > 0.0);
      CHECK(statistics::welch_p_value(a, b) > unlikely);
    }
    errors.push_back(mean_of_pixels(rendering, 0).standard_error);
  }
  return errors;
}

/// A plate that fills the view from 45 degrees above, under a small light and a large one where its mirror image shows.
test::TestScene plate(const pathtracer::GpuMaterial& material) {
  test::TestScene scene;
  scene.add_quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, scene.add_material(material));
  const std::uint32_t bright = scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(60, 40, 20)));
  const std::uint32_t wide = scene.add_material(test::diffuse(glm::vec3(0.3f), glm::vec3(1, 2, 3)));
  scene.add_quad({-1.1f, 1, -0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}, bright);
  scene.add_quad({-3, 0.2f, -2}, {0, 2.5f, 0}, {0, 0, 4}, wide);
  scene.add_lights();
  return scene;
}

RenderConstants looking_down(const test::TestScene& scene) {
  RenderConstants constants = test::render_constants({1, 1, 0}, 48, 48, scene);
  constants.camera_forward = {-0.70710678f, -0.70710678f, 0};
  constants.camera_right = {0, 0, -0.1f};
  constants.camera_up = {-0.070710678f, 0.070710678f, 0};
  constants.max_depth = 5;
  return constants;
}

}  // namespace

TANDEM_DEVICE_TEST("All techniques give a diffuse plate between lights the same radiance") {
  const test::TestScene scene = plate(test::diffuse({0.8f, 0.5f, 0.3f}));
  compare_techniques(device, 0, scene, looking_down(scene));
}

TANDEM_DEVICE_TEST(
    "All techniques give a glossy plate under small and large lights the same radiance, and weighted they have least "
    "noise") {
  pathtracer::GpuMaterial material = test::diffuse({0.1f, 0.2f, 0.3f});
  material.model = MaterialModel::blinn_phong;
  material.reflectance = {0.8f, 0.7f, 0.6f};
  material.exponent = 200;
  const test::TestScene scene = plate(material);
  const std::vector<double> errors = compare_techniques(device, feature::materials, scene, looking_down(scene));
  // Weighted, it is much less noisy than BSDF sampling alone and no worse than light sampling alone. Half of the error
  // is the difference between pixels.
  CHECK(errors[0] < 0.6 * errors[3]);
  CHECK(errors[0] < 1.1 * errors[1]);
}

TANDEM_DEVICE_TEST("All techniques give rough glass between lights the same radiance") {
  pathtracer::GpuMaterial material = test::glass(1.5f);
  material.model = MaterialModel::rough_dielectric;
  material.roughness = 0.6f;
  test::TestScene scene = plate(material);
  scene.lights.clear();
  scene.add_quad({-2, -2, -2}, {2, 0, 0}, {0, 0, 4}, scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(2))));
  scene.add_lights();
  compare_techniques(device, feature::materials, scene, looking_down(scene));
}

TANDEM_DEVICE_TEST("All techniques give a diffuse plane under a uniform sky the radiance of its albedo") {
  test::TestScene scene;
  scene.add_quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, scene.add_material(test::diffuse({0.5f, 0.25f, 0.75f})));
  scene.lights.push_back({.threshold = 0xffffffffu, .kind = pathtracer::LightKind::environment, .probability = 1});
  scene.environment_cells.push_back({0xffffffffu, 0, 0.25f * std::numbers::inv_pi_v<float>});
  RenderConstants constants = looking_down(scene);
  constants.background = glm::vec3(1);
  constants.environment_light = 0;
  compare_techniques(device, feature::lights, scene, constants);
  constants.dispatch.sample_count = sample_count;
  const test::Rendering rendering =
      test::path_trace(device, test::path_trace_pipeline(device, feature::lights | feature::options),
                       test::upload(device, scene), {constants});
  CHECK(std::abs(statistics::z_score(mean_of_pixels(rendering, 0), 0.5)) < 5);
  CHECK(std::abs(statistics::z_score(mean_of_pixels(rendering, 2), 0.75)) < 5);
}
