#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "pathtracer/scene/scene.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/shaders/scene_kernel.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

TextureImage float_image(std::uint32_t width, std::uint32_t height, const std::vector<float>& values) {
  const auto bytes = std::as_bytes(std::span(values));
  return {.name = "made",
          .format = TexelFormat::float32,
          .width = width,
          .height = height,
          .texels = {bytes.begin(), bytes.end()}};
}

/// An image of one normal in tangent space.
TextureImage normal_image(const glm::vec3& normal) {
  const glm::vec3 texel = 0.5f * normal + 0.5f;
  return float_image(1, 1, {texel.x, texel.y, texel.z, 1});
}

/// Heights that rise by `across` from the left to the right edge and by `upwards` from the lower to the upper one.
TextureImage ramp_image(float across, float upwards) {
  std::vector<float> values;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x)
      values.insert(values.end(), 4, across * (float(x) + 0.5f) / 16 + upwards * (1 - (float(y) + 0.5f) / 8));
  return float_image(16, 8, values);
}

/// A ray at a triangle, and the shading normal that it should find there.
struct Query {
  std::uint32_t triangle;
  glm::vec3 origin;
  glm::vec3 direction;
  glm::dvec3 expected;
};

std::vector<glm::dvec3> shading_normals(rhi::Device& device, const Scene& scene, const std::vector<Query>& queries) {
  std::vector<std::uint32_t> inputs;
  for (const Query& query : queries) {
    inputs.push_back(query.triangle);
    for (const glm::vec3& v : {query.origin, query.direction})
      for (int i = 0; i < 3; ++i) inputs.push_back(std::bit_cast<std::uint32_t>(v[i]));
  }
  const std::vector<std::uint32_t> bits = test::run_bits(device, scene,
                                                         {.includes = "#include \"geometry/surface.glsl\"",
                                                          .body = R"(
    vec3 origin = vec3(input_float(1), input_float(2), input_float(3));
    vec3 direction = vec3(input_float(4), input_float(5), input_float(6));
    vec3 normal = surface_at(input_bits(0), origin, direction, 0.0).shading_normal;
    output_float(0, normal.x); output_float(1, normal.y); output_float(2, normal.z);)",
                                                          .input_count = 7,
                                                          .output_count = 3},
                                                         inputs);
  std::vector<glm::dvec3> normals;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    glm::dvec3 normal;
    for (std::size_t k = 0; k < 3; ++k) normal[static_cast<int>(k)] = double{std::bit_cast<float>(bits[3 * i + k])};
    normals.push_back(normal);
  }
  return normals;
}

glm::dvec3 unit_vector(test::RandomSource& random) {
  for (;;) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const glm::dvec3 v(x, y, z);
    if (glm::dot(v, v) > 0.01 && glm::dot(v, v) < 1.0) return glm::normalize(v);
  }
}

Scene empty_scene() {
  Scene scene;
  scene.name = "test";
  return scene;
}

/// A triangle with texture coordinates in general position, some of them mirrored, and what follows from them.
struct TexturedTriangle {
  glm::dvec3 a, edge_b, edge_c, normal;
  glm::dvec3 by_u, by_v;  ///< how a point moves with its texture coordinates
  bool usable;            ///< no sliver
};

TexturedTriangle add_triangle(Scene& scene, test::RandomSource& random, std::uint32_t material) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  std::array<glm::dvec3, 3> corners;
  std::array<glm::dvec2, 3> uv;
  for (std::size_t i = 0; i < 3; ++i) {
    scene.positions.emplace_back(unit_vector(random));
    const double u = random.uniform(-2, 2), v = random.uniform(-2, 2);
    scene.texture_coordinates.emplace_back(u, v);
    corners[i] = scene.positions.back();
    uv[i] = scene.texture_coordinates.back();
  }
  scene.normals.resize(scene.positions.size());
  scene.triangles.push_back({{first, first + 1, first + 2}, material});
  TexturedTriangle triangle{.a = corners[0],
                            .edge_b = corners[1] - corners[0],
                            .edge_c = corners[2] - corners[0],
                            .normal = {},
                            .by_u = {},
                            .by_v = {},
                            .usable = false};
  const glm::dvec3 cross = glm::cross(triangle.edge_b, triangle.edge_c);
  triangle.normal = glm::normalize(cross);
  const glm::dvec2 b = uv[1] - uv[0], c = uv[2] - uv[0];
  const double determinant = b.x * c.y - b.y * c.x;
  triangle.by_u = (c.y * triangle.edge_b - b.y * triangle.edge_c) / determinant;
  triangle.by_v = (b.x * triangle.edge_c - c.x * triangle.edge_b) / determinant;
  triangle.usable = glm::length(cross) > 0.3 && std::abs(determinant) > 0.5;
  return triangle;
}

/// A ray at the middle of it, 60 degrees from its normal at most, from the side of `side` (1 or -1).
Query query_at(const TexturedTriangle& triangle, std::uint32_t index, double side, test::RandomSource& random) {
  const glm::dvec3 point = triangle.a + (triangle.edge_b + triangle.edge_c) / 3.0;
  glm::dvec3 towards = unit_vector(random);
  while (side * glm::dot(towards, triangle.normal) < 0.5) towards = unit_vector(random);
  const glm::vec3 origin = point + 2.0 * towards;
  return {.triangle = index,
          .origin = origin,
          .direction = glm::normalize(point - glm::dvec3(origin)),
          .expected = side * triangle.normal};
}

double worst_error(const std::vector<glm::dvec3>& normals, const std::vector<Query>& queries) {
  double worst = 0;
  for (std::size_t i = 0; i < queries.size(); ++i)
    worst = std::max(worst, glm::length(normals[i] - queries[i].expected));
  return worst;
}

constexpr int triangle_count = 2000;

}  // namespace

TANDEM_DEVICE_TEST("A normal map leans the normal along the texture's axes, mirrored or not, seen from either side") {
  Scene scene = empty_scene();
  // 0.48, 0.36 of length 0.6: 37 degrees off.
  const glm::vec3 local(0.48f, 0.36f, 0.8f);
  GpuMaterial material = diffuse_material(glm::vec3(0.5f));
  material.normal_texture = add_texture(scene, normal_image(local));
  scene.materials.push_back(material);
  // One that is turned by a quarter, and whose map counts half.
  material.normal_texture = add_texture(scene, normal_image(local));
  material.normal_scale = 0.5f;
  scene.textures.back().gpu.u_row = {0, 2, 0.5f};
  scene.textures.back().gpu.v_row = {-2, 0, 0};
  scene.materials.push_back(material);
  test::RandomSource random(61);
  std::vector<Query> queries;
  int mirrored = 0, kept = 0;
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const TexturedTriangle triangle = add_triangle(scene, random, i % 2);
    if (!triangle.usable) continue;
    const double side = random.bits() % 2 == 0 ? 1 : -1;
    Query query = query_at(triangle, i, side, random);
    // s = 2 v + 0.5 and t = -2 u grow along v and against u.
    const glm::dvec3 by_s = i % 2 == 0 ? triangle.by_u : triangle.by_v;
    const glm::dvec3 by_t = i % 2 == 0 ? triangle.by_v : -triangle.by_u;
    const glm::dvec3 along_s = glm::normalize(by_s);
    const bool is_mirrored = glm::dot(glm::cross(by_s, by_t), triangle.normal) < 0;
    const glm::dvec3 along_t = (is_mirrored ? -1.0 : 1.0) * glm::cross(triangle.normal, along_s);
    const double scale = i % 2 == 0 ? 1 : 0.5;
    const glm::dvec3 bent = glm::normalize(scale * 0.48 * along_s + scale * 0.36 * along_t + 0.8 * triangle.normal);
    const double facing = glm::dot(side * bent, -glm::dvec3(query.direction));
    if (std::abs(facing) < 1e-3) continue;  // either is right
    // Seen from behind it does not count.
    if (facing > 0) query.expected = side * bent;
    mirrored += is_mirrored;
    kept += facing < 0;
    queries.push_back(query);
  }
  REQUIRE(queries.size() > 500);
  CHECK(mirrored > 100);
  CHECK(kept > 10);
  // Roundings of 6e-8 over an area of 0.3 and a determinant of 0.5, some twenty times.
  CHECK(worst_error(shading_normals(device, scene, queries), queries) < 2e-5);
}

TANDEM_DEVICE_TEST("A flat normal map changes nothing but roundings, and one without texture coordinates nothing") {
  Scene scene = empty_scene();
  GpuMaterial material = diffuse_material(glm::vec3(0.5f));
  material.normal_texture = add_texture(scene, normal_image({0, 0, 1}));
  scene.materials.push_back(material);
  material.normal_texture = add_texture(scene, normal_image({0.6f, 0, 0.8f}));
  scene.materials.push_back(material);
  test::RandomSource random(62);
  std::vector<Query> queries;
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const TexturedTriangle triangle = add_triangle(scene, random, i % 2);
    // No area of texture coordinates, so no direction of their axes.
    if (i % 2 == 1)
      for (std::size_t corner = 0; corner < 3; ++corner) scene.texture_coordinates[3 * i + corner] = {0.25f, 0.5f};
    if (triangle.usable) queries.push_back(query_at(triangle, i, i % 4 < 2 ? 1 : -1, random));
  }
  REQUIRE(queries.size() > 500);
  CHECK(worst_error(shading_normals(device, scene, queries), queries) < 2e-6);
}

TANDEM_DEVICE_TEST("A bump map leans the normal against the slope of its heights") {
  Scene scene = empty_scene();
  GpuMaterial material = diffuse_material(glm::vec3(0.5f));
  material.bump_texture = add_texture(scene, ramp_image(0.7f, -0.4f));
  material.normal_scale = 0.25f;
  // The triangles' own coordinates, from -2 to 2, in the middle of the image, where it has no edge.
  GpuTexture& gpu = scene.textures.back().gpu;
  gpu.u_row = {0.1f, 0, 0.5f};
  gpu.v_row = {0, 0.1f, 0.5f};
  scene.materials.push_back(material);
  test::RandomSource random(63);
  std::vector<Query> queries;
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const TexturedTriangle triangle = add_triangle(scene, random, 0);
    if (!triangle.usable) continue;
    const double side = random.bits() % 2 == 0 ? 1 : -1;
    Query query = query_at(triangle, i, side, random);
    // Height above the triangle at each point of it, by the chain rule: 0.25 (0.7 * 0.1 u - 0.4 * 0.1 v). The normal of
    // the displaced surface is the cross product of its derivatives.
    const glm::dvec3 p_u = triangle.by_u + 0.25 * 0.07 * triangle.normal;
    const glm::dvec3 p_v = triangle.by_v - 0.25 * 0.04 * triangle.normal;
    glm::dvec3 bent = glm::normalize(glm::cross(p_u, p_v));
    if (glm::dot(bent, triangle.normal) < 0) bent = -bent;
    if (std::abs(glm::dot(bent, glm::dvec3(query.direction))) < 1e-3) continue;
    if (side * glm::dot(bent, glm::dvec3(query.direction)) < 0) query.expected = side * bent;
    queries.push_back(query);
  }
  REQUIRE(queries.size() > 500);
  // Heights are rounded at 6e-8, and their differences over a texel taken 16 times.
  CHECK(worst_error(shading_normals(device, scene, queries), queries) < 2e-5);
}
