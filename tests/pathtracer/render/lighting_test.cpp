#include <cmath>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "pathtracer/render/renderer.hpp"
#include "tests/pathtracer/render/picture.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::pathtracer;
using tandem::test::Estimate;
using tandem::test::estimate;
using tandem::test::rendered;

namespace {

constexpr double pi = std::numbers::pi;

/// A floor of albedo 1/2 at y = 0.
Scene floor_scene() {
  Scene scene;
  scene.name = "floor";
  scene.positions = {{-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}};
  scene.normals.resize(4);
  scene.triangles = {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}};
  scene.materials = {diffuse_material(glm::vec3(0.5f))};
  return scene;
}

/// Sees a thousandth of a unit of the floor around the origin, over which light varies by less than 1e-3, evenly to all
/// sides.
const RenderSettings settings{
    .width = 16, .height = 16, .max_depth = 2, .camera = Camera{.position = {0, 1, 3}, .vertical_fov = 0.02f}};

const PunctualLight above{.kind = LightKind::point, .position = {0, 2, 0}, .radiance = glm::vec3(8)};
const PunctualLight aside{.kind = LightKind::point, .position = {3, 4, 0}, .radiance = glm::vec3(50)};
const PunctualLight sun{.kind = LightKind::directional, .direction = {0, -4, 3}, .radiance = glm::vec3(2)};
const PunctualLight spot{.kind = LightKind::spot,
                         .position = {0, 2, 0},
                         .direction = {0, -1, 0},
                         .radiance = glm::vec3(12),
                         .inner_angle = 10,
                         .outer_angle = 20};

/// Irradiance of the origin.
double irradiance(const PunctualLight& light) {
  if (light.kind == LightKind::directional) return double{light.radiance.x} * 0.8;
  const double distance = std::hypot(double{light.position.x}, double{light.position.y});
  return double{light.radiance.x} * double{light.position.y} / (distance * distance * distance);
}

}  // namespace

TANDEM_DEVICE_TEST("A floor under lights without extent has their analytic radiance") {
  Scene scene = floor_scene();
  // A card halfway to a light that nothing else gets in the way of.
  const PunctualLight hidden{.kind = LightKind::point, .position = {-2, 2, 0}, .radiance = glm::vec3(8)};
  scene.positions.insert(scene.positions.end(), {{-1.1f, 1, -0.1f}, {-0.9f, 1, -0.1f}, {-1, 1, 0.2f}});
  scene.normals.resize(scene.positions.size());
  scene.triangles.push_back({{4, 5, 6}, 0});
  Renderer renderer(device_handle, scene, settings);
  const auto result = [&](const std::vector<PunctualLight>& lights, std::uint32_t samples) {
    renderer.set_lights(lights);
    renderer.render(samples);
    return estimate(renderer.image());
  };
  for (const PunctualLight& light : {above, aside, sun, spot}) {
    // One light has no variance but that of the places that the camera sees.
    CHECK(result({light}, 4).mean == doctest::Approx(0.5 / pi * irradiance(light)).epsilon(1e-4));
  }
  const Estimate all = result({above, aside, hidden, sun}, 256);
  const double expected = 0.5 / pi * (irradiance(above) + irradiance(aside) + irradiance(sun));
  CHECK(all.standard_error < 0.01 * expected);
  CHECK(std::abs(all.mean - expected) < 4 * all.standard_error + 1e-4 * expected);
}

TANDEM_DEVICE_TEST("A constant environment lights a floor, by whichever way it is found") {
  Scene scene = floor_scene();
  scene.environment = Environment{.radiance = glm::vec3(0.75f)};
  const Estimate result = estimate(rendered(device_handle, scene, settings, 64));
  CHECK(result.standard_error < 0.01 * 0.375);
  CHECK(std::abs(result.mean - 0.375) < 4 * result.standard_error + 1e-5);
}

TANDEM_DEVICE_TEST("Lights that change while rendering give what a renderer made for them gives") {
  Scene scene = floor_scene();
  scene.materials.push_back(diffuse_material(glm::vec3(0), glm::vec3(5)));
  scene.positions.insert(scene.positions.end(), {{-1, 2, -1}, {1, 2, -1}, {0, 2, 1}});
  scene.normals.resize(scene.positions.size());
  scene.triangles.push_back({{4, 5, 6}, 1});
  const RenderSettings wide{.width = 16, .height = 16, .max_depth = 4, .camera = Camera{.position = {0, 1, 3}}};
  Renderer renderer(device_handle, scene, wide);
  renderer.render(4);
  const Image light_alone = renderer.image();

  Scene lit = scene;
  lit.lights = {aside, sun, spot};
  Renderer made_for_them(device_handle, lit, wide);
  renderer.set_lights(lit.lights);
  CHECK(renderer.samples() == 0);
  renderer.render(4);
  made_for_them.render(4);
  CHECK(renderer.image().pixels == made_for_them.image().pixels);
  CHECK(renderer.image().pixels != light_alone.pixels);

  PunctualLight broken = sun;
  broken.direction = glm::vec3(0);
  CHECK_THROWS_WITH_AS(renderer.set_lights(std::vector{broken}),
                       "light 0 of floor: its direction is zero or not finite", Error);
  CHECK(renderer.samples() == 4);

  renderer.set_lights({});
  renderer.render(4);
  CHECK(renderer.image().pixels == light_alone.pixels);
}
