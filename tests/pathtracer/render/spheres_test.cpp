// Analytic spheres in whole pictures.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "tests/pathtracer/render/picture.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

Scene empty_scene() {
  Scene scene;
  scene.name = "spheres";
  return scene;
}

std::uint32_t add_material(Scene& scene, const GpuMaterial& material) {
  scene.materials.push_back(material);
  scene.material_names.emplace_back("material");
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

void add_sphere(Scene& scene, glm::vec3 centre, float radius, std::uint32_t material, glm::vec3 motion = glm::vec3(0)) {
  scene.spheres.push_back({.centre = centre, .radius = radius, .motion = motion, .material = material});
}

GpuMaterial mirror() {
  GpuMaterial material;
  material.model = MaterialModel::mirror;
  material.base_color = glm::vec3(0);
  material.reflectance = {0.9f, 0.8f, 0.7f};
  return material;
}

GpuMaterial glass() {
  GpuMaterial material;
  material.model = MaterialModel::dielectric;
  material.base_color = glm::vec3(0);
  material.ior = 1.5f;
  return material;
}

GpuMaterial half_covering(glm::vec3 albedo) {
  GpuMaterial material = diffuse_material(albedo);
  material.opacity = 0.5f;
  return material;
}

/// Spheres of all kinds on a huge one, as in Ray Tracing in One Weekend; some move, one lets half of the rays pass, and
/// a few triangles are there too.
Scene one_weekend() {
  Scene scene = empty_scene();
  const std::uint32_t ground = add_material(scene, diffuse_material(glm::vec3(0.5f)));
  const std::uint32_t brown = add_material(scene, diffuse_material({0.4f, 0.2f, 0.1f}));
  const std::uint32_t shiny = add_material(scene, mirror());
  const std::uint32_t clear = add_material(scene, glass());
  const std::uint32_t veil = add_material(scene, half_covering({0.8f, 0.1f, 0.1f}));
  add_sphere(scene, {0, -1000, 0}, 1000, ground);
  add_sphere(scene, {0, 1, 0}, 1, clear);
  add_sphere(scene, {-4, 1, 0}, 1, brown);
  add_sphere(scene, {4, 1, 0}, 1, shiny);
  for (int a = -4; a < 4; ++a)
    for (int b = -4; b < 4; ++b) {
      const auto number = static_cast<std::uint32_t>((a + 4) * 8 + b + 4);
      const glm::vec3 centre(1.7f * static_cast<float>(a) + 0.3f, 0.2f, 1.3f * static_cast<float>(b) + 0.2f);
      add_sphere(scene, centre, 0.2f, number % 5, number % 3 == 0 ? glm::vec3(0, 0.4f, 0) : glm::vec3(0));
    }
  scene.positions = {{-6, 0, -3}, {-6, 3, -3}, {-2, 3, -4}, {-2, 0, -4}};
  scene.normals.resize(4, glm::vec3(0, 0, 1));
  scene.triangles = {{.vertices = {0, 1, 2}, .material = brown}, {.vertices = {0, 2, 3}, .material = veil}};
  return scene;
}

const RenderSettings one_weekend_view{.width = 96,
                                      .height = 64,
                                      .max_depth = 10,
                                      .camera = Camera{.position = {13, 2, 3}, .vertical_fov = 25},
                                      .background = glm::vec3(0.7f, 0.8f, 1.0f)};

/// Straight at the origin from z = 10; 2 high at z = 0.
const RenderSettings front_view{.width = 64,
                                .height = 64,
                                .max_depth = 1,
                                .camera = Camera{.position = {0, 0, 10}, .vertical_fov = 11.42118627f},
                                .background = glm::vec3(1)};

}  // namespace

TANDEM_DEVICE_TEST(
    "Ray queries and a pipeline see the same spheres, still and moving, opaque and not, to the last bit") {
  const Scene scene = one_weekend();
  std::vector<Image> images;
  for (const TracingMode form : test::tracing_modes(device))
    images.push_back(test::rendered(device_handle, scene, one_weekend_view, 4, form));
  for (const Image& image : images) CHECK(image.pixels == images.front().pixels);
  const test::Estimate estimate = test::estimate(images.front());
  CHECK(estimate.mean > 0.2);
  CHECK(estimate.mean < 0.7);
}

TEST_CASE("All devices see the same spheres") {
  const test::NoWarnings no_warnings;
  const Scene scene = one_weekend();
  std::vector<Image> images;
  for (const std::string& name : test::device_names())
    images.push_back(test::rendered(test::device(name), scene, one_weekend_view, 4));
  for (const Image& image : images) {
    std::size_t different = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) different += image.pixels[i] != images.front().pixels[i];
    // Where a triangle and a sphere meet, a device's own t of the triangle decides; 100,000 rays do so rarely.
    CHECK(different <= 6);
  }
}

TANDEM_DEVICE_TEST("A scene of one sphere and nothing else shows a disk, as large as perspective makes it") {
  Scene scene = empty_scene();
  add_sphere(scene, {0, 0, 0}, 0.75f, add_material(scene, diffuse_material(glm::vec3(0))));
  for (const TracingMode form : test::tracing_modes(device)) {
    CAPTURE(name(form));
    const Image image = test::rendered(device_handle, scene, front_view, 16, form);
    // Its silhouette is the circle of the tangents from the camera, on the plane z = 0, 2 high.
    const double radius = 10 * std::tan(std::asin(0.75 / 10));
    const double covered = 3.14159265358979 * radius * radius / 4;
    CHECK(1 - test::estimate(image).mean == doctest::Approx(covered).epsilon(0.005));
    for (std::uint32_t y = 0; y < 64; ++y)
      for (std::uint32_t x = 0; x < 64; ++x) {
        const double distance = std::hypot((x + 0.5) / 32 - 1, (y + 0.5) / 32 - 1);
        if (distance < radius - 0.03) REQUIRE(image.at(x, y).x == 0.0f);
        if (distance > radius + 0.03) REQUIRE(image.at(x, y).x == 1.0f);
      }
  }
}

TANDEM_DEVICE_TEST("A moving sphere covers each pixel for the part of the time that it is there") {
  // A thin column of pixels that the disk of radius 0.25 crosses from x = -0.6 to 0.6 within the time of the shutter.
  Scene scene = empty_scene();
  add_sphere(scene, {-0.6f, 0, 0}, 0.25f, add_material(scene, diffuse_material(glm::vec3(0))), {1.2f, 0, 0});
  constexpr std::uint32_t samples = 256;
  for (const TracingMode form : test::tracing_modes(device)) {
    CAPTURE(name(form));
    const Image image = test::rendered(device_handle, scene, front_view, samples, form);
    double worst = 0;
    for (std::uint32_t y = 0; y < 64; ++y)
      for (std::uint32_t x = 0; x < 64; ++x) {
        // The mean over the pixel and over time, by a fine grid; the silhouette is that of the disk within 0.1 %.
        double covered = 0;
        for (int i = 0; i < 4; ++i)
          for (int j = 0; j < 4; ++j) {
            const double px = (x + (i + 0.5) / 4) / 32 - 1, py = (y + (j + 0.5) / 4) / 32 - 1;
            const double half = std::sqrt(std::max(0.0, 0.0625 - py * py));
            const double enters = std::clamp((px - half + 0.6) / 1.2, 0.0, 1.0);
            const double leaves = std::clamp((px + half + 0.6) / 1.2, 0.0, 1.0);
            covered += (leaves - enters) / 16;
          }
        const double deviation = std::sqrt(covered * (1 - covered) / samples);
        worst = std::max(worst, std::abs(1 - image.at(x, y).x - covered) - 5 * deviation);
      }
    // Beyond five deviations there is only what the grid misses at the rim.
    CHECK(worst < 0.02);
  }
}

TANDEM_DEVICE_TEST("White spheres in a white room of light disappear") {
  // Whatever they are made of: a furnace. Glass and mirror lose nothing, and a white diffuse sphere is convex.
  RenderSettings settings = front_view;
  settings.max_depth = 64;
  GpuMaterial perfect_mirror = mirror();
  perfect_mirror.reflectance = glm::vec3(1);
  for (const GpuMaterial& material : {diffuse_material(glm::vec3(1)), perfect_mirror, glass()}) {
    Scene scene = empty_scene();
    add_sphere(scene, {0, 0, 0}, 0.75f, add_material(scene, material));
    const test::Estimate estimate = test::estimate(test::rendered(device_handle, scene, settings, 16));
    // Only Russian roulette and the last of 64 segments inside glass are noise.
    CHECK(estimate.mean == doctest::Approx(1).epsilon(0.003));
  }
}

TANDEM_DEVICE_TEST(
    "A sphere of opacity 1/2 hides a quarter more than one layer does: its inside is behind its outside") {
  Scene scene = empty_scene();
  GpuMaterial material = half_covering(glm::vec3(0));
  material.opacity = 0.5f;
  add_sphere(scene, {0, 0, 0}, 5, add_material(scene, material));
  for (const TracingMode form : test::tracing_modes(device)) {
    CAPTURE(name(form));
    const test::Estimate estimate = test::estimate(test::rendered(device_handle, scene, front_view, 64, form));
    CHECK(std::abs(estimate.mean - 0.25) < 4 * estimate.standard_error);
  }
}

TANDEM_DEVICE_TEST("The inside of a half transparent sphere is seen where its outside is not") {
  Scene scene = empty_scene();
  GpuMaterial material = half_covering(glm::vec3(0));
  material.emission = glm::vec3(1);
  add_sphere(scene, {0, 0, 0}, 5, add_material(scene, material));
  // Depth tells the sides apart: a second, opaque sphere in between hides the far one.
  Scene with_core = scene;
  add_sphere(with_core, {0, 0, 0}, 4, add_material(with_core, diffuse_material(glm::vec3(0))));
  RenderSettings settings = front_view;
  settings.background = glm::vec3(0);
  const test::Estimate both = test::estimate(test::rendered(device_handle, scene, settings, 64));
  CHECK(std::abs(both.mean - 0.75) < 4 * both.standard_error);
  const test::Estimate near = test::estimate(test::rendered(device_handle, with_core, settings, 64));
  CHECK(std::abs(near.mean - 0.5) < 4 * near.standard_error);
}
