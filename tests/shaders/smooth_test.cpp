// Interpolated normals.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "tests/shaders/random_source.hpp"
#include "tests/shaders/scene_queries.hpp"
#include "tests/shaders/test_scene.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using pathtracer::triangle_smooth;
using test::RenderConstants;

namespace {

const char* const shading_normals = R"(#version 460
#extension GL_EXT_ray_query : require
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "geometry/surface.glsl"
struct Query {
  vec3 origin;
  uint triangle;
  vec3 direction;
  float padding;
};
layout(set = 1, binding = 2, std430) readonly buffer Queries { Query queries[]; };
layout(set = 1, binding = 3, std430) buffer Answers { float answers[]; };

void main() {
  uint row = gl_GlobalInvocationID.x;
  if (row >= queries.length()) return;
  Surface surface = surface_at(queries[row].triangle, queries[row].origin, queries[row].direction, 0.0);
  answers[3 * row] = surface.shading_normal.x;
  answers[3 * row + 1] = surface.shading_normal.y;
  answers[3 * row + 2] = surface.shading_normal.z;
}
)";

struct Query {
  glm::vec3 origin;
  std::uint32_t triangle;
  glm::vec3 direction;
  float padding;
};

std::vector<float> run_shading_normals(rhi::Device& device, const test::TestScene& scene,
                                       const std::vector<Query>& queries) {
  return test::answer_queries(device, test::upload(device, scene), shading_normals, "shading normals", queries,
                              std::vector<float>(3 * queries.size()));
}

glm::dvec3 unit_vector(test::RandomSource& random) {
  for (;;) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const glm::dvec3 v(x, y, z);
    if (glm::dot(v, v) > 0.01 && glm::dot(v, v) < 1.0) return glm::normalize(v);
  }
}

double mean(const test::Rendering& rendering, std::uint32_t sample_count) {
  double sum = 0.0;
  for (const float value : rendering.radiance_sum) sum += value;
  return sum / (static_cast<double>(rendering.radiance_sum.size()) * sample_count);
}

/// A camera on the z axis that sees the unit sphere and a little around it.
RenderConstants camera_on_unit_sphere(std::uint32_t side, const test::TestScene& scene) {
  RenderConstants constants = test::render_constants({0, 0, 5}, side, side, scene);
  constants.camera_right = {0.25f, 0, 0};
  constants.camera_up = {0, 0.25f, 0};
  return constants;
}

/// Root of the mean squared difference from the exact shading of a white unit sphere under a small distant light, which
/// is the cosine between the normal and the direction to the light.
double shading_error(rhi::Device& device, int subdivisions, std::uint32_t smooth) {
  constexpr std::uint32_t side = 96, samples = 16;
  const glm::dvec3 to_light(0.6, 0, 0.8);
  test::TestScene scene;
  const std::uint32_t white = scene.add_material(test::diffuse(glm::vec3(1)));
  // A light of 10 x 10 at distance 1000: irradiance pi across its light.
  const auto radiance = static_cast<float>(std::numbers::pi * 1e4);
  const std::uint32_t light = scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(radiance)));
  scene.add_sphere(glm::dvec3(0), 1, subdivisions, white | smooth);
  scene.add_quad(glm::vec3(1000.0 * to_light) + glm::vec3(-4, -5, 3), {8, 0, -6}, {0, 10, 0}, light);
  scene.add_lights();
  RenderConstants constants = camera_on_unit_sphere(side, scene);
  constants.max_depth = 2;
  constants.dispatch.sample_count = samples;
  const test::Rendering rendering = test::path_trace(device, test::upload(device, scene), {constants});

  double squares = 0.0;
  int count = 0;
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const glm::dvec3 origin(0, 0, 5);
      const glm::dvec3 direction =
          glm::normalize(glm::dvec3(0.25 * (2 * (x + 0.5) / side - 1), 0.25 * (1 - 2 * (y + 0.5) / side), -1));
      const double along = -glm::dot(origin, direction);
      const double discriminant = along * along - glm::dot(origin, origin) + 1;
      if (discriminant < 0) continue;
      const glm::dvec3 normal = origin + (along - std::sqrt(discriminant)) * direction;
      const double cosine = glm::dot(normal, to_light);
      // Not near the silhouette, which facets have elsewhere, nor where facets begin to turn away from the light.
      if (cosine < 0.3 || -glm::dot(normal, direction) < 0.5) continue;
      const double error = double{rendering.radiance_sum[3 * (y * side + x)]} / samples - cosine;
      squares += error * error;
      ++count;
    }
  REQUIRE(count > 2000);
  return std::sqrt(squares / count);
}

}  // namespace

TANDEM_DEVICE_TEST("The shading normal is interpolated between the vertices, on the side of the viewer") {
  test::RandomSource random(31);
  test::TestScene scene;
  const std::uint32_t material = scene.add_material(test::diffuse(glm::vec3(0.5f))) | triangle_smooth;
  std::vector<Query> queries;
  std::vector<glm::dvec3> expected;
  int interpolated = 0;
  while (scene.triangles.size() < 2000) {
    const glm::vec3 corners[3] = {unit_vector(random), unit_vector(random), unit_vector(random)};
    const glm::dvec3 a(corners[0]), edge_b = glm::dvec3(corners[1]) - a, edge_c = glm::dvec3(corners[2]) - a;
    const glm::dvec3 cross = glm::cross(edge_b, edge_c);
    if (glm::length(cross) < 0.3) continue;
    const glm::dvec3 facet = glm::normalize(cross);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    // Some are turned to the other side, as files have them.
    const double side = random.bits() % 4 == 0 ? -1.0 : 1.0;
    for (const glm::vec3& corner : corners) {
      scene.positions.push_back(corner);
      scene.normals.emplace_back(side * glm::normalize(facet + 0.9 * unit_vector(random)));
    }
    scene.triangles.push_back({.vertices = {first, first + 1, first + 2}, .material = material});
    for (int i = 0; i < 20; ++i) {
      double b = random.uniform(0, 1), c = random.uniform(0, 1);
      if (b + c > 1) {
        b = 1 - b;
        c = 1 - c;
      }
      const glm::vec3 origin = 3.0 * unit_vector(random);
      const glm::vec3 direction = glm::normalize(a + b * edge_b + c * edge_c - glm::dvec3(origin));
      const double towards = glm::dot(facet, glm::dvec3(direction));
      if (std::abs(towards) < 0.05) continue;
      const glm::dvec3 geometric = towards < 0 ? facet : -facet;
      glm::dvec3 normal =
          glm::normalize((1 - b - c) * glm::dvec3(scene.normals[first]) + b * glm::dvec3(scene.normals[first + 1]) +
                         c * glm::dvec3(scene.normals[first + 2]));
      if (glm::dot(normal, geometric) < 0) normal = -normal;
      const double facing = glm::dot(normal, glm::dvec3(direction));
      if (std::abs(facing) < 1e-3) continue;  // either is right
      interpolated += facing < 0;
      queries.push_back({.origin = origin, .triangle = first / 3, .direction = direction, .padding = 0});
      expected.push_back(facing < 0 ? normal : geometric);
    }
  }
  REQUIRE(interpolated > 20000);
  REQUIRE(static_cast<int>(queries.size()) > interpolated + 1000);
  const std::vector<float> normals = run_shading_normals(device, scene, queries);
  double worst = 0.0, worst_length = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const glm::dvec3 normal(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
    worst = std::max(worst, glm::length(normal - expected[i]));
    worst_length = std::max(worst_length, std::abs(glm::length(normal) - 1));
  }
  // Directions rounded at 6e-8, over a distance of 4, a cosine of 0.05 and an area of 0.3 at the worst.
  CHECK(worst < 1e-4);
  CHECK(worst_length < 2e-7);
}

TANDEM_DEVICE_TEST("Smooth shading of a coarse sphere is as right as flat shading of a fine one") {
  // Facets of up to 18 degrees. An interpolated normal is that of the point on the facet, which lies up to 1.5 % inside
  // of the sphere; the rest is the noise of 16 points in a pixel of 0.02 radii.
  CHECK(shading_error(device, 8, triangle_smooth) < 0.006);
  CHECK(shading_error(device, 128, 0) < 0.003);
  // What a facet's own normal is off, some six degrees: this test can tell.
  CHECK(shading_error(device, 8, 0) > 0.02);
}

TANDEM_DEVICE_TEST("Under a uniform sky a smooth sphere has its albedo, but for directions into its facets") {
  test::TestScene scene;
  scene.add_sphere(glm::dvec3(0), 1, 8, scene.add_material(test::diffuse(glm::vec3(0.5f))) | triangle_smooth);
  RenderConstants constants = camera_on_unit_sphere(128, scene);
  constants.background = glm::vec3(1);
  const test::Rendering rendering = test::path_trace(device, test::upload(device, scene), {constants});
  int sky = 0, scattered = 0, lost = 0;
  for (std::size_t pixel = 0; pixel < rendering.ray_counts.size(); ++pixel) {
    const float radiance = rendering.radiance_sum[3 * pixel];
    const std::uint32_t rays = rendering.ray_counts[pixel];
    sky += radiance == 1.0f && rays == 1;
    scattered += radiance == 0.5f && rays == 2;
    lost += radiance == 0.0f && rays == 1;
  }
  CHECK(sky + scattered + lost == 128 * 128);
  CHECK(scattered > 6000);
  // Around a normal that is off by an angle x, (1 - cos x) / 2 of a cosine lobe points below: 0.8 % for 10 degrees, the
  // most there is.
  CHECK(lost < 0.008 * scattered);
}

TANDEM_DEVICE_TEST("No light comes through a smooth surface, however its normals lean") {
  test::RandomSource random(37);
  for (const bool is_mirror : {false, true}) {
    test::TestScene scene;
    const std::uint32_t material =
        scene.add_material(is_mirror ? test::mirror(glm::vec3(1)) : test::diffuse(glm::vec3(1))) | triangle_smooth;
    const std::uint32_t light = scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(100)));
    for (int i = -20; i < 20; ++i) {
      scene.add_quad({static_cast<float>(i), -20, -5}, {1, 0, 0}, {0, 40, 0}, material);
      for (int corner = 0; corner < 4; ++corner)
        scene.normals.emplace_back(glm::normalize(glm::dvec3(0, 0, 1) + 0.99 * unit_vector(random)));
    }
    scene.add_quad({-100, -100, -6}, {200, 0, 0}, {0, 200, 0}, light);
    scene.add_lights();
    RenderConstants constants = test::render_constants({0.5f, 0.25f, 0}, 64, 64, scene);
    constants.dispatch.sample_count = 4;
    const test::Rendering rendering = test::path_trace(device, test::upload(device, scene), {constants});
    CHECK(std::all_of(rendering.radiance_sum.begin(), rendering.radiance_sum.end(),
                      [](float value) { return value == 0.0f; }));
    // Nor is any energy made where it comes from above: under a sky of radiance 1 at most 1 is reflected, and by the
    // mirror, which always finds a direction, all of it.
    constants.background = glm::vec3(1);
    constants.max_depth = 2;
    constants.light_count = 0;
    const test::Rendering lit = test::path_trace(device, test::upload(device, scene), {constants});
    for (const float value : lit.radiance_sum) REQUIRE(value <= 4.0f);
    if (is_mirror) CHECK(mean(lit, 4) == 1.0);
  }
}

TANDEM_DEVICE_TEST("A smooth sphere of index 1 is invisible, exactly; one of glass under a uniform sky on average") {
  for (const float ior : {1.0f, 1.5f}) {
    test::TestScene scene;
    scene.add_sphere(glm::dvec3(0), 1, 16, scene.add_material(test::glass(ior)) | triangle_smooth);
    RenderConstants constants = camera_on_unit_sphere(64, scene);
    constants.background = glm::vec3(1);
    constants.max_depth = 400;
    constants.dispatch.sample_count = 16;
    const test::Rendering rendering = test::path_trace(device, test::upload(device, scene), {constants});
    if (ior == 1.0f) {
      for (const float value : rendering.radiance_sum) REQUIRE(value == 16.0f);
      continue;
    }
    // Roulette is the only noise: at worst every path is continued at 95 % with weight 1 / 0.95, so that a sample
    // deviates by less than sqrt(0.06), and five deviations of the mean of 65536 samples are 0.005.
    CHECK(mean(rendering, 16) == doctest::Approx(1.0).epsilon(0.005));
    // Before roulette there is none: reflected at once, or refracted in and out.
    constants.max_depth = 3;
    const test::Rendering direct = test::path_trace(device, test::upload(device, scene), {constants});
    for (const float value : direct.radiance_sum) {
      // Each sample is 0 (it went on inside) or 1, to within the rounding of (1 / 1.5)^2 1.5^2 and of the sum.
      REQUIRE(std::abs(value - std::round(value)) < 1e-5f);
      REQUIRE(value < 16.1f);
    }
    // 4 % of what is refracted in is reflected inside, more near the silhouette.
    CHECK(mean(direct, 16) > 0.9);
  }
}

TEST_CASE("All devices shade smooth spheres to the last bit") {
  const test::NoWarnings no_warnings;
  test::TestScene scene;
  const std::uint32_t white = scene.add_material(test::diffuse(glm::vec3(0.7f, 0.6f, 0.5f)));
  const std::uint32_t shiny = scene.add_material(test::mirror(glm::vec3(0.9f)));
  const std::uint32_t clear = scene.add_material(test::glass(1.5f));
  const std::uint32_t light = scene.add_material(test::diffuse(glm::vec3(0), glm::vec3(20)));
  scene.add_quad({-9, -1, 9}, {18, 0, 0}, {0, 0, -18}, white);
  scene.add_quad({-1, 4, -1}, {2, 0, 0}, {0, 0, 2}, light);
  scene.add_sphere({-2.1, 0, -1}, 0.95, 8, white | triangle_smooth);
  scene.add_sphere({0, 0, -1}, 0.95, 8, shiny | triangle_smooth);
  scene.add_sphere({2.1, 0, -1}, 0.95, 8, clear | triangle_smooth);
  scene.add_lights();
  RenderConstants constants = test::render_constants({0.1f, 1, 4}, 128, 128, scene);
  constants.background = {0.2f, 0.3f, 0.4f};
  constants.dispatch.sample_count = 4;
  std::vector<test::Rendering> renderings;
  for (const std::string& name : test::device_names()) {
    rhi::Device& device = *test::device(name);
    renderings.push_back(test::path_trace(device, test::upload(device, scene), {constants}));
  }
  for (const test::Rendering& rendering : renderings) {
    int different = 0;
    for (std::size_t pixel = 0; pixel < rendering.ray_counts.size(); ++pixel)
      different += !std::equal(&rendering.radiance_sum[3 * pixel], &rendering.radiance_sum[3 * pixel] + 3,
                               &renderings.front().radiance_sum[3 * pixel]);
    // A ray through a shared edge may hit either triangle; 300,000 rays here do so a few times at most.
    CHECK(different <= 3);
  }
}
