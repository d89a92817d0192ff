#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/vec3.hpp>

#include "pathtracer/render/features.hpp"
#include "tests/shaders/test_scene.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using test::RenderConstants;
namespace feature = pathtracer::feature;

namespace {

/// A closed room around the origin with a light under its ceiling; one wall may be of another material.
test::TestScene room(const pathtracer::GpuMaterial& wall) {
  test::TestScene scene;
  const std::uint32_t white = scene.add_material(test::diffuse(glm::vec3(0.7f, 0.6f, 0.5f)));
  const std::uint32_t light = scene.add_material(test::diffuse(glm::vec3(0.2f), glm::vec3(12, 10, 8)));
  const std::uint32_t other = scene.add_material(wall);
  scene.add_quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, white);
  scene.add_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);
  scene.add_quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, white);
  scene.add_quad({1, -1, 1}, {-2, 0, 0}, {0, 2, 0}, white);
  scene.add_quad({-1, -1, 1}, {0, 0, -2}, {0, 2, 0}, white);
  scene.add_quad({1, -1, -1}, {0, 0, 2}, {0, 2, 0}, other);
  scene.add_quad({-0.4f, 0.9f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, light);
  scene.add_lights();
  return scene;
}

RenderConstants inside(const test::TestScene& scene) {
  RenderConstants constants = test::render_constants({-0.3f, 0, 0.9f}, 40, 40, scene);
  constants.dispatch.sample_count = 4;
  return constants;
}

bool same(const test::Rendering& a, const test::Rendering& b) {
  return a.radiance_sum == b.radiance_sum && a.ray_counts == b.ray_counts;
}

double mean(const test::Rendering& rendering, std::uint32_t sample_count) {
  double sum = 0.0;
  for (const float value : rendering.radiance_sum) sum += value;
  return sum / (static_cast<double>(rendering.radiance_sum.size()) * sample_count);
}

}  // namespace

TANDEM_DEVICE_TEST("Options and media that are on and not used change no bit") {
  // Those of the integrator: to compile all of them takes minutes.
  const std::uint32_t features = feature::options | feature::media;
  const rhi::ComputePipelineHandle pipeline = test::path_trace_pipeline(device, features);
  for (const pathtracer::GpuMaterial& wall : {test::mirror(glm::vec3(0.9f, 0.8f, 0.7f)), test::glass(1.5f)}) {
    const test::TestScene scene = room(wall);
    const test::DeviceScene device_scene = test::upload(device, scene);
    const RenderConstants constants = inside(scene);
    const test::Rendering plain = test::path_trace(device, device_scene, {constants});
    const test::Rendering all = test::path_trace(device, pipeline, device_scene, {constants});
    CHECK(plain.radiance_sum == all.radiance_sum);
    CHECK(plain.ray_counts == all.ray_counts);
    CHECK(mean(plain, 4) > 0.1);
  }
}

TANDEM_DEVICE_TEST("Depth limits and the direct integrator end paths where max_depth would, and mirrors by their own") {
  const rhi::ComputePipelineHandle pipeline = test::path_trace_pipeline(device, feature::options);
  {
    const test::TestScene scene = room(test::diffuse(glm::vec3(0.2f, 0.3f, 0.4f)));
    const test::DeviceScene device_scene = test::upload(device, scene);
    for (const std::uint32_t limit : {0u, 1u, 4u}) {
      RenderConstants constants = inside(scene);
      constants.max_depth = limit + 2;
      const test::Rendering by_depth = test::path_trace(device, pipeline, device_scene, {constants});
      constants.max_depth = 8;
      CHECK_FALSE(same(by_depth, test::path_trace(device, pipeline, device_scene, {constants})));
      constants.max_diffuse_depth = limit;
      constants.max_specular_depth = 0;
      constants.max_glossy_depth = 0;
      CHECK(same(by_depth, test::path_trace(device, pipeline, device_scene, {constants})));
      if (limit != 0) continue;
      constants.max_diffuse_depth = 0xffffffffu;
      constants.integrator = pathtracer::Integrator::direct;
      CHECK(same(by_depth, test::path_trace(device, pipeline, device_scene, {constants})));
    }
  }
  // A mirror that fills the view and shows a wall with a light in front of it, all behind the camera.
  test::TestScene scene;
  scene.add_quad({-50, -50, -5}, {100, 0, 0}, {0, 100, 0}, scene.add_material(test::mirror(glm::vec3(1))));
  scene.add_quad({-50, -50, 5}, {0, 100, 0}, {100, 0, 0}, scene.add_material(test::diffuse(glm::vec3(0.5f))));
  scene.add_quad({-1, -1, 4}, {2, 0, 0}, {0, 2, 0}, scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(4))));
  scene.add_lights();
  const test::DeviceScene device_scene = test::upload(device, scene);
  RenderConstants constants = inside(scene);
  constants.camera_position = glm::vec3(0);
  constants.max_specular_depth = 0;
  const test::Rendering none = test::path_trace(device, pipeline, device_scene, {constants});
  constants.max_specular_depth = 1;
  const test::Rendering once = test::path_trace(device, pipeline, device_scene, {constants});
  // The first corner of the picture shows the wall, its centre the light.
  CHECK(none.radiance_sum[0] == 0.0f);
  CHECK(once.radiance_sum[0] > 0.0f);
  const std::size_t centre = 3 * (20 * 40 + 20);
  CHECK(none.radiance_sum[centre] == 16.0f);
  // The direct integrator looks through mirrors.
  constants.max_specular_depth = 0xffffffffu;
  constants.integrator = pathtracer::Integrator::direct;
  CHECK(test::path_trace(device, pipeline, device_scene, {constants}).radiance_sum[0] > 0.0f);
}

TANDEM_DEVICE_TEST("Clamping scales all channels alike, keeps bounds, and changes nothing where it is off or wide") {
  const rhi::ComputePipelineHandle pipeline = test::path_trace_pipeline(device, feature::options);
  const test::TestScene scene = room(test::diffuse(glm::vec3(0.5f)));
  const test::DeviceScene device_scene = test::upload(device, scene);
  RenderConstants constants = inside(scene);
  constants.dispatch.sample_count = 1;
  const test::Rendering free = test::path_trace(device, pipeline, device_scene, {constants});
  constants.clamp_direct = constants.clamp_indirect = 1e20f;
  CHECK(same(free, test::path_trace(device, pipeline, device_scene, {constants})));

  constants.max_depth = 1;
  constants.clamp_direct = 6;
  const test::Rendering emission = test::path_trace(device, pipeline, device_scene, {constants});
  std::size_t lit = 0;
  for (std::size_t pixel = 0; pixel < emission.ray_counts.size(); ++pixel) {
    const float* value = &emission.radiance_sum[3 * pixel];
    if (value[0] == 0.0f) continue;
    // The light's 12, 10, 8 times 1 / 2.
    CHECK((value[0] == 6.0f && value[1] == 5.0f && value[2] == 4.0f));
    ++lit;
  }
  CHECK(lit > 10);

  // Light along more segments only: at most two contributions of each of the six later vertices.
  constants.max_depth = 8;
  constants.clamp_direct = 0;
  constants.clamp_indirect = 1e-3f;
  const test::Rendering indirect = test::path_trace(device, pipeline, device_scene, {constants});
  constants.max_depth = 2;
  const test::Rendering direct = test::path_trace(device, pipeline, device_scene, {constants});
  for (std::size_t i = 0; i < direct.radiance_sum.size(); ++i) {
    // Rounding of a sum of at most 13 numbers below 100.
    REQUIRE(indirect.radiance_sum[i] >= direct.radiance_sum[i]);
    REQUIRE(indirect.radiance_sum[i] <= direct.radiance_sum[i] + 12e-3f + 1e-4f);
  }
}

TANDEM_DEVICE_TEST(
    "Ambient occlusion beside a long wall is that of its form factor, and rays beyond its length see nothing") {
  const rhi::ComputePipelineHandle pipeline = test::path_trace_pipeline(device, feature::options);
  // All pixels look at the origin, one unit from a wall of height 1. Seen from there its upper edge is at 45 degrees,
  // and of an endless strip the form factor is half the difference of the sines of its edges' angles to the normal.
  test::TestScene scene;
  const std::uint32_t black = scene.add_material(test::mirror(glm::vec3(0)));
  scene.add_quad({-5000, 0, 5000}, {10000, 0, 0}, {0, 0, -10000}, black);
  scene.add_quad({-1, 0, -5000}, {0, 1, 0}, {0, 0, 10000}, black);
  const test::DeviceScene device_scene = test::upload(device, scene);
  RenderConstants constants = test::render_constants({1, 1, 0}, 64, 64, scene);
  constants.camera_forward = {-0.70710678f, -0.70710678f, 0};
  constants.camera_right = {0, 0, -1e-4f};
  constants.camera_up = {-0.70710678e-4f, 0.70710678e-4f, 0};
  constants.integrator = pathtracer::Integrator::ambient_occlusion;
  constants.dispatch.sample_count = 16;
  const double truth = 1.0 - 0.5 * (1.0 - std::sqrt(0.5));
  const test::Rendering rendering = test::path_trace(device, pipeline, device_scene, {constants});
  // Of 65536 yes or no answers: five deviations.
  const double error = 5.0 * std::sqrt(truth * (1.0 - truth) / 65536.0);
  CHECK(std::abs(mean(rendering, 16) - truth) < error);
  for (const std::uint32_t count : rendering.ray_counts) REQUIRE(count == 32);

  constants.occlusion_length = 0.99f;
  for (const float value : test::path_trace(device, pipeline, device_scene, {constants}).radiance_sum)
    REQUIRE(value == 16.0f);
  // The sky is not occluded.
  constants.camera_forward = {0.70710678f, 0.70710678f, 0};
  for (const float value : test::path_trace(device, pipeline, device_scene, {constants}).radiance_sum)
    REQUIRE(value == 16.0f);
}
