#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "base/statistics/means.hpp"
#include "pathtracer/scene/lights.hpp"
#include "tests/shaders/light_samples.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/statistics/chi_square.hpp"

using namespace tandem;
using namespace tandem::pathtracer;
using tandem::test::irradiances;
using tandem::test::light_samples;
using tandem::test::LightSample;

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t count = 200000;

// Each statistical check fails by chance once in 100,000 (fixed seeds: if it passes, it always does).
constexpr double least_p_value = 1e-5;
constexpr double most_standard_errors = 4.4;

/// A small dark triangle, so that there is geometry.
Scene dark_scene() {
  Scene scene;
  scene.name = "test";
  scene.positions = {{-1, -5, 0}, {1, -5, 0}, {0, -5, 1}};
  scene.normals.resize(3);
  scene.triangles.push_back({{0, 1, 2}, 0});
  scene.materials.push_back(diffuse_material(glm::vec3(0.5f)));
  return scene;
}

std::uint32_t add_emission(Scene& scene, float radiance) {
  scene.materials.push_back(diffuse_material(glm::vec3(0), glm::vec3(radiance)));
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

void add_triangle(Scene& scene, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, std::uint32_t material) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), {a, b, c});
  scene.normals.resize(scene.positions.size());
  scene.triangles.push_back({{first, first + 1, first + 2}, material});
}

/// The light of Lambert's formula: a rectangle in general position.
const glm::vec3 rectangle[4] = {{-1, 2, -0.5f}, {1, 2.5f, -0.5f}, {1, 2.5f, 1.5f}, {-1, 2, 1.5f}};

Scene rectangle_scene(float radiance) {
  Scene scene = dark_scene();
  const std::uint32_t material = add_emission(scene, radiance);
  add_triangle(scene, rectangle[0], rectangle[1], rectangle[2], material);
  add_triangle(scene, rectangle[0], rectangle[2], rectangle[3], material);
  return scene;
}

Scene sphere_scene(const glm::vec3& centre, float radius, float radiance) {
  Scene scene = dark_scene();
  scene.spheres.push_back({.centre = centre, .radius = radius, .material = add_emission(scene, radiance)});
  return scene;
}

/// Of a polygon that is wholly above the horizon of a surface element at the origin (Lambert 1760).
double polygon_irradiance(std::span<const glm::vec3> vertices, const glm::dvec3& normal, double radiance) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const glm::dvec3 a = glm::normalize(glm::dvec3(vertices[i]));
    const glm::dvec3 b = glm::normalize(glm::dvec3(vertices[(i + 1) % vertices.size()]));
    sum += std::acos(glm::dot(a, b)) * glm::normalize(glm::cross(a, b));
  }
  return 0.5 * radiance * std::abs(glm::dot(sum, normal));
}

void check_mean(const std::vector<double>& values, double truth) {
  const statistics::Mean mean = statistics::mean_of(values);
  CAPTURE(truth);
  CAPTURE(mean.value);
  CAPTURE(mean.standard_error);
  CHECK(mean.standard_error < 0.02 * truth);
  // Where there is no variance, the roundings of some twenty operations are left.
  CHECK(std::abs(mean.value - truth) < most_standard_errors * mean.standard_error + 2e-6 * truth);
}

/// What a path that finds the light by scattering would think of each sample: the very same number.
void check_two_routes(const std::vector<LightSample>& samples) {
  std::size_t different = 0;
  double worst_length = 0;
  for (const LightSample& sample : samples) {
    different +=
        std::bit_cast<std::uint32_t>(sample.density) != std::bit_cast<std::uint32_t>(sample.scattering_density);
    worst_length = std::max(worst_length, std::abs(glm::length(glm::dvec3(sample.direction)) - 1));
  }
  CHECK(different == 0);
  CHECK(worst_length < 4e-7);
}

}  // namespace

TANDEM_DEVICE_TEST("A triangle is sampled uniformly, with the density of its solid angle") {
  Scene scene = dark_scene();
  const glm::dvec3 a(-1, 2, -0.5), b(1, 2.5, -0.5), c(0.5, 1.5, 1.5);
  add_triangle(scene, glm::vec3(a), glm::vec3(b), glm::vec3(c), add_emission(scene, 3));
  const glm::vec3 position(0.3f, 0.1f, -0.2f);
  const std::vector<LightSample> samples = light_samples(device, scene, position, count);
  check_two_routes(samples);
  const glm::dvec3 cross = glm::cross(b - a, c - a);
  const double area = 0.5 * glm::length(cross);
  std::vector<double> bins(20 * 20, 0.0);
  double worst_density = 0;
  for (const LightSample& sample : samples) {
    REQUIRE(sample.primitive == 1);
    CHECK(sample.radiance == glm::vec3(3));
    const glm::dvec3 offset = glm::dvec3(sample.target) - a;
    const double beta = glm::dot(glm::cross(offset, c - a), cross) / glm::dot(cross, cross);
    const double gamma = glm::dot(glm::cross(b - a, offset), cross) / glm::dot(cross, cross);
    // The two numbers that a uniform point comes from.
    const double sum = std::clamp(beta + gamma, 1e-12, 1.0 - 1e-12);
    const double along = std::clamp(gamma / sum, 0.0, 1.0 - 1e-12);
    bins[test::unit_interval_bin(sum * sum, 20) * 20 + test::unit_interval_bin(along, 20)] += 1;
    const glm::dvec3 to_target = glm::dvec3(sample.target) - glm::dvec3(position);
    const double distance = glm::length(to_target);
    const double cosine = std::abs(glm::dot(to_target, cross)) / (distance * 2 * area);
    worst_density = std::max(worst_density, std::abs(sample.density * area * cosine / (distance * distance) - 1));
  }
  CHECK(test::chi_square_uniform(bins).p_value > least_p_value);
  CHECK(worst_density < 2e-6);  // some ten roundings of 6e-8
}

TANDEM_DEVICE_TEST("From outside, a sphere is sampled uniformly over its solid angle") {
  // Far away, near, and closer than its radius.
  for (const double distance : {40.0, 3.0, 1.2}) {
    CAPTURE(distance);
    const glm::vec3 position(0.3f, 0.1f, -0.2f);
    const glm::dvec3 pole = glm::normalize(glm::dvec3(0.4, 0.8, -0.3));
    const auto centre = glm::vec3(glm::dvec3(position) + distance * pole);
    const Scene scene = sphere_scene(centre, 1, 2);
    const std::vector<LightSample> samples = light_samples(device, scene, position, count, 0, 1);
    check_two_routes(samples);
    const double exact_distance = glm::distance(glm::dvec3(centre), glm::dvec3(position));
    const glm::dvec3 exact_pole = (glm::dvec3(centre) - glm::dvec3(position)) / exact_distance;
    const double sine = 1 / exact_distance;
    const double height = sine * sine / (1 + std::sqrt(1 - sine * sine));
    const glm::dvec3 tangent = glm::normalize(glm::cross(exact_pole, glm::dvec3(1, 0, 0)));
    const glm::dvec3 bitangent = glm::cross(exact_pole, tangent);
    std::vector<double> bins(20 * 20, 0.0);
    double worst_target = 0, worst_line = 0, highest = 0;
    for (const LightSample& sample : samples) {
      CHECK(sample.radiance == glm::vec3(2));
      CHECK(sample.density == doctest::Approx(1 / (2 * pi * height)).epsilon(2e-6));
      const glm::dvec3 direction(sample.direction);
      // From the sine: 1 - cosine of a float direction would have few digits.
      const double x = glm::dot(direction, tangent), y = glm::dot(direction, bitangent);
      const double squared_sine = x * x + y * y;
      const double below = squared_sine / (1 + std::sqrt(1 - squared_sine));
      highest = std::max(highest, below / height);
      const double turn = std::atan2(y, x) / (2 * pi) + 0.5;
      bins[test::unit_interval_bin(std::min(below / height, 1 - 1e-12), 20) * 20 +
           test::unit_interval_bin(std::min(turn, 1 - 1e-12), 20)] += 1;
      const glm::dvec3 target(sample.target);
      worst_target = std::max(worst_target, std::abs(glm::distance(target, glm::dvec3(centre)) - 1));
      const glm::dvec3 to_target = target - glm::dvec3(position);
      worst_line = std::max(worst_line, glm::length(glm::cross(to_target, direction)));
      CHECK(glm::dot(glm::dvec3(sample.target_normal), direction) < 1e-3);
    }
    CHECK(test::chi_square_uniform(bins).p_value > least_p_value);
    // Coordinates of up to 40 have roundings of 2e-6; at the silhouette, where the direction touches the sphere, an
    // error e of the direction's sine moves the point by the root of 2 e.
    CHECK(highest < 1 + 1e-3);
    CHECK(worst_target < 4e-6);
    CHECK(worst_line < 1e-4);
  }
}

TANDEM_DEVICE_TEST("From inside, a sphere is sampled uniformly over its area") {
  const glm::dvec3 centre(1, 2, 3);
  const Scene scene = sphere_scene(glm::vec3(centre), 2, 5);
  const glm::vec3 position(1.5f, 2.5f, 1.75f);
  const std::vector<LightSample> samples = light_samples(device, scene, position, count, 0, 1);
  check_two_routes(samples);
  const test::SphereBins sphere;
  std::vector<double> bins(sphere.count(), 0.0);
  double worst_density = 0;
  for (const LightSample& sample : samples) {
    const glm::dvec3 normal = (glm::dvec3(sample.target) - centre) / 2.0;
    bins[sphere.bin(glm::normalize(normal))] += 1;
    const glm::dvec3 to_target = glm::dvec3(sample.target) - glm::dvec3(position);
    const double distance = glm::length(to_target);
    const double density = distance * distance / (glm::dot(to_target, normal) / distance) / (4 * pi * 4);
    worst_density = std::max(worst_density, std::abs(sample.density / density - 1));
  }
  CHECK(test::chi_square_uniform(bins).p_value > least_p_value);
  CHECK(worst_density < 5e-6);
  // From everywhere inside an emissive sphere all directions have its radiance.
  check_mean(irradiances(samples, glm::normalize(glm::dvec3(1, -2, 0.5))), pi * 5);
}

TANDEM_DEVICE_TEST("Where rays may pass the near side of a sphere, both sides are sampled") {
  Scene scene = sphere_scene({0, 3, 0}, 1, 2);
  scene.materials[1].opacity = 0.75f;
  const std::vector<LightSample> samples = light_samples(device, scene, glm::vec3(0), count, 0, 1);
  check_two_routes(samples);
  // A ray meets the near side three times in four, and the far one as often when it has passed the near one.
  std::vector<LightSample> visible = samples;
  for (LightSample& sample : visible)
    if (glm::dot(sample.target_normal, sample.direction) > 0) sample.radiance *= 0.25f;
  check_mean(irradiances(visible, {0, 1, 0}), pi * 2 / 9 * (0.75 + 0.25 * 0.75));
}

TANDEM_DEVICE_TEST("A textured emitter sends what its texture says") {
  Scene scene = sphere_scene({0, 3, 0}, 1, 2);
  add_triangle(scene, {-1, 2, 0}, {1, 2, 0}, {1, 2, 1}, 1);
  // One half of all u, and of the triangle's, is red, the other green.
  scene.texture_coordinates.resize(scene.positions.size());
  scene.texture_coordinates[4] = {1, 0};
  scene.texture_coordinates[5] = {1, 1};
  TextureImage image{.name = "test", .format = TexelFormat::unorm8, .width = 2, .height = 1, .texels = {}};
  for (const int value : {255, 0, 0, 255, 0, 255, 0, 255}) image.texels.push_back(std::byte(value));
  scene.materials[1].emission_texture = add_texture(scene, image);
  scene.textures.back().gpu.filter = TextureFilter::nearest;
  std::size_t wrong = 0, triangles = 0;
  for (const LightSample& sample : light_samples(device, scene, glm::vec3(0.25f), 10000, 0, 2)) {
    const bool is_triangle = sample.primitive == 1;
    triangles += is_triangle;
    // A sphere's u begins at -x and goes by +z.
    const double x = sample.target.x, z = sample.target.z;
    if (std::abs(is_triangle ? x : z) < 1e-5) continue;
    const bool is_red = is_triangle ? x < 0 : z > 0;
    wrong += sample.radiance != (is_red ? glm::vec3(2, 0, 0) : glm::vec3(0, 2, 0));
  }
  CHECK(wrong == 0);
  CHECK(triangles > 300);
}

TANDEM_DEVICE_TEST("Irradiance below a sphere is pi L (r / d)^2 cos") {
  for (const double distance : {30.0, 4.0, 1.5}) {
    CAPTURE(distance);
    const double cosine = distance > 2 ? 0.6 : 1.0;
    const Scene scene =
        sphere_scene(glm::vec3(glm::dvec3(distance * std::sqrt(1 - cosine * cosine), 0, distance * cosine)), 1, 2);
    check_mean(irradiances(light_samples(device, scene, glm::vec3(0), count, 0, 1), {0, 0, 1}),
               pi * 2 / (distance * distance) * cosine);
  }
}

TANDEM_DEVICE_TEST("A moving sphere is where it is at that time") {
  Scene scene = sphere_scene({0, 4, 0}, 1, 2);
  scene.spheres[0].motion = {4, 0, 0};
  for (const float time : {0.0f, 0.5f, 1.0f}) {
    const std::vector<LightSample> samples = light_samples(device, scene, glm::vec3(0), 1000, time, 1);
    check_two_routes(samples);
    const glm::dvec3 centre(4 * double{time}, 4, 0);
    for (const LightSample& sample : samples)
      CHECK(glm::distance(glm::dvec3(sample.target), centre) == doctest::Approx(1).epsilon(2e-6));
    const double distance = glm::length(centre);
    check_mean(irradiances(samples, {0, 1, 0}), pi * 2 / (distance * distance) * (4 / distance));
  }
}

TANDEM_DEVICE_TEST("Irradiance of a rectangle is that of Lambert's formula") {
  const Scene scene = rectangle_scene(3);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2, 1, 0.1));
  const std::vector<LightSample> samples = light_samples(device, scene, glm::vec3(0), count);
  check_two_routes(samples);
  check_mean(irradiances(samples, normal), polygon_irradiance(rectangle, normal, 3));
}

TANDEM_DEVICE_TEST("A point light gives I cos / d^2") {
  Scene scene = dark_scene();
  scene.lights.push_back({.kind = LightKind::point, .position = {1, 2, 2}, .radiance = glm::vec3(9, 18, 27)});
  for (const LightSample& sample : light_samples(device, scene, glm::vec3(0), 100)) {
    CHECK(sample.density == 0);
    CHECK(!sample.infinite);
    CHECK(sample.target == glm::vec3(1, 2, 2));
    CHECK(sample.target_normal == glm::vec3(0));
    CHECK(glm::distance(sample.direction, glm::vec3(1, 2, 2) / 3.0f) < 2e-7f);
    CHECK(glm::distance(sample.radiance, glm::vec3(1, 2, 3)) < 1e-6f);
  }
  // At the light itself there is no direction to it.
  for (const LightSample& sample : light_samples(device, scene, {1, 2, 2}, 100)) CHECK(sample.radiance == glm::vec3(0));
}

TANDEM_DEVICE_TEST("A spot light fades between its cones as KHR_lights_punctual says") {
  Scene scene = dark_scene();
  scene.lights.push_back({.kind = LightKind::spot,
                          .position = {0, 2, 0},
                          .direction = {0, -1, 0},
                          .radiance = glm::vec3(4),
                          .inner_angle = 20,
                          .outer_angle = 50});
  const double inner = std::cos(20 * pi / 180), outer = std::cos(50 * pi / 180);
  for (const double degrees : {0.0, 10.0, 19.9, 20.1, 30.0, 40.0, 49.9, 50.1, 70.0, 120.0, 180.0}) {
    CAPTURE(degrees);
    const double angle = degrees * pi / 180;
    const auto position = glm::vec3(glm::dvec3(2 * std::sin(angle), 2 - 2 * std::cos(angle), 0));
    // The extension's formula: saturate(cos * scale + offset) squared.
    const double scale = 1 / std::max(0.001, inner - outer);
    const double attenuation = std::clamp(std::cos(angle) * scale - outer * scale, 0.0, 1.0);
    for (const LightSample& sample : light_samples(device, scene, position, 3)) {
      CHECK(sample.density == 0);
      CHECK(sample.radiance.x == doctest::Approx(attenuation * attenuation).epsilon(1e-5));
    }
  }
}

TANDEM_DEVICE_TEST("A directional light comes from everywhere the same") {
  Scene scene = dark_scene();
  scene.lights.push_back({.kind = LightKind::directional, .direction = {0, -3, 4}, .radiance = glm::vec3(2, 3, 4)});
  for (const glm::vec3 position : {glm::vec3(0), glm::vec3(100, -3, 7)})
    for (const LightSample& sample : light_samples(device, scene, position, 10)) {
      CHECK(sample.infinite);
      CHECK(sample.density == 0);
      CHECK(glm::distance(sample.direction, glm::vec3(0, 0.6f, -0.8f)) < 1e-7f);
      CHECK(glm::distance(sample.radiance, glm::vec3(2, 3, 4)) < 1e-6f);
    }
}

TANDEM_DEVICE_TEST("Lights are chosen by their share of the power") {
  Scene scene = dark_scene();
  std::vector<double> powers = {0};
  for (int i = 1; i <= 12; ++i) {
    const auto side = static_cast<float>(i);
    const float radiance = i % 3 == 0 ? 0.0f : 1.0f / side;
    add_triangle(scene, {0, 0, 0}, {side, 0, 0}, {0, side, 0}, add_emission(scene, radiance));
    powers.push_back(0.5 * side * side * double{radiance});
  }
  std::vector<double> chosen(powers.size(), 0.0);
  for (const LightSample& sample : light_samples(device, scene, {0.1f, 0.2f, 3}, count)) chosen[sample.primitive] += 1;
  CHECK(test::chi_square(chosen, powers).p_value > least_p_value);
}

TANDEM_DEVICE_TEST("Lights of all kinds together give the sum of their irradiances") {
  Scene scene = rectangle_scene(3);
  scene.spheres.push_back({.centre = {0, 5, 3}, .radius = 0.5f, .material = add_emission(scene, 20)});
  scene.environment = Environment{.radiance = glm::vec3(0.5f)};
  scene.lights.push_back({.kind = LightKind::point, .position = {0, 3, 0}, .radiance = glm::vec3(9)});
  scene.lights.push_back({.kind = LightKind::directional, .direction = {0, -1, 0}, .radiance = glm::vec3(0.25f)});
  scene.lights.push_back(
      {.kind = LightKind::spot, .position = {0, 2, 0}, .direction = {0, -1, 0}, .radiance = glm::vec3(2)});
  const glm::dvec3 up(0, 1, 0);
  const double squared_distance = 25 + 9;
  const double truth = polygon_irradiance(rectangle, up, 3) +
                       pi * 20 * 0.25 / squared_distance * (5 / std::sqrt(squared_distance)) + pi * 0.5 + 9.0 / 9 +
                       0.25 + 2.0 / 4;
  const std::vector<LightSample> samples =
      light_samples(device, scene, glm::vec3(0), count, 0, static_cast<std::uint32_t>(scene.triangles.size()));
  check_two_routes(samples);
  check_mean(irradiances(samples, up), truth);
}

TEST_CASE("Every device samples lights with the same bits") {
  const test::NoWarnings no_warnings;
  Scene scene = rectangle_scene(3);
  scene.spheres.push_back({.centre = {0, 5, 3}, .radius = 0.5f, .material = add_emission(scene, 20)});
  scene.environment = Environment{.radiance = glm::vec3(0.5f), .rotation = 33};
  scene.lights.push_back({.kind = LightKind::point, .position = {0, 3, 0}, .radiance = glm::vec3(9)});
  scene.lights.push_back(
      {.kind = LightKind::spot, .position = {0, 2, 0}, .direction = {1, -1, 0}, .radiance = glm::vec3(2)});
  const std::vector<std::string>& names = test::device_names();
  const std::vector<LightSample> expected =
      light_samples(*test::device(names.front()), scene, {0.1f, 0, 0.2f}, count, 0, 3);
  for (std::size_t other = 1; other < names.size(); ++other) {
    const std::vector<LightSample> actual =
        light_samples(*test::device(names[other]), scene, {0.1f, 0, 0.2f}, count, 0, 3);
    std::size_t different = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const LightSample &a = expected[i], &b = actual[i];
      different += a.direction != b.direction || a.radiance != b.radiance || a.density != b.density ||
                   a.target != b.target || a.target_normal != b.target_normal || a.target_offset != b.target_offset ||
                   a.primitive != b.primitive || a.infinite != b.infinite;
    }
    CHECK(different == 0);
  }
}
