#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/vec3.hpp>

#include "tests/shaders/random_source.hpp"
#include "tests/shaders/scene_queries.hpp"
#include "tests/shaders/test_scene.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

/// A sphere of small quads, seen counter-clockwise from outside.
test::TestScene sphere(const glm::dvec3& centre, double radius) {
  constexpr int rings = 24, segments = 48;
  test::TestScene scene;
  const std::uint32_t material = scene.add_material(test::diffuse(glm::vec3(0.5f)));
  for (int ring = 0; ring <= rings; ++ring)
    for (int segment = 0; segment < segments; ++segment) {
      const double theta = std::numbers::pi * ring / rings, phi = 2 * std::numbers::pi * segment / segments;
      scene.positions.push_back(centre + radius * glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                             -std::sin(theta) * std::sin(phi)));
    }
  const auto vertex = [](int ring, int segment) {
    return static_cast<std::uint32_t>(ring * segments + segment % segments);
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int segment = 0; segment < segments; ++segment) {
      const std::uint32_t a = vertex(ring, segment), b = vertex(ring + 1, segment), c = vertex(ring + 1, segment + 1),
                          d = vertex(ring, segment + 1);
      if (ring + 1 < rings) scene.triangles.push_back({.vertices = {a, b, c}, .material = material});
      if (ring > 0) scene.triangles.push_back({.vertices = {a, c, d}, .material = material});
    }
  return scene;
}

const char* const leaving_rays = R"(#version 460
#extension GL_EXT_ray_query : require
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "geometry/frame.glsl"
#include "geometry/surface.glsl"
#include "sampling/hemisphere.glsl"
#include "sampling/triangle.glsl"
#include "trace.glsl"
struct Query {
  uvec2 triangles;
  vec2 points[2];
  vec2 direction;
  float flatness;
  float padding;
};
layout(set = 1, binding = 2, std430) readonly buffer Queries { Query queries[]; };
layout(set = 1, binding = 3, std430) buffer Answers { uint answers[]; };

void point_inside(uint index, vec2 u, out vec3 position, out vec3 inwards, out float offset) {
  TriangleVertices triangle = triangle_vertices(triangles[index].vertices);
  position = barycentric_point(triangle, uniform_triangle(u));
  inwards = -triangle_normal(triangle, vec3(0.0));
  offset = offset_distance(position, inwards, triangle_extent(triangle));
}

void main() {
  uint row = gl_GlobalInvocationID.x;
  if (row >= queries.length()) return;
  vec3 from, to, from_normal, to_normal;
  float from_offset, to_offset;
  point_inside(queries[row].triangles.x, queries[row].points[0], from, from_normal, from_offset);
  point_inside(queries[row].triangles.y, queries[row].points[1], to, to_normal, to_offset);

  vec3 local = cosine_hemisphere(queries[row].direction);
  vec3 direction = det_normalize(to_world(make_frame(from_normal), vec3(local.xy, local.z * queries[row].flatness)), from_normal);
  vec3 origin = offset_point(from, from_normal, from_offset, direction);
  uint hit = trace_closest(origin, direction, RAY_LENGTH, RandomKey(0, 0, 0), 0);
  vec3 inside = offset_point(from, from_normal, from_offset, from_normal);
  vec3 between = offset_point(to, to_normal, to_offset, to_normal) - inside;
  bool occluded = trace_occluded(inside, between, 1.0, RandomKey(0, 0, 0), 0);
  answers[row] = (hit == queries[row].triangles.x ? 1u : 0u) | (hit == NO_PRIMITIVE ? 2u : 0u) | (occluded ? 4u : 0u);
}
)";

struct Query {
  std::uint32_t triangles[2];
  float points[2][2];
  float direction[2];
  float flatness;
  float padding;
};

}  // namespace

TANDEM_DEVICE_TEST(
    "From inside a sphere every ray meets the sphere, none where it starts, and nothing lies between two points") {
  test::RandomSource random(23);
  const auto uniform = [&] { return static_cast<float>(random.bits() >> 8) * 0x1p-24f; };
  // The last sphere lies ten radii from the origin: its coordinates have fewer bits for its shape.
  const std::vector<std::pair<glm::dvec3, double>> spheres = {
      {{0, 0, 0}, 1}, {{0, 0, 0}, 1e-4}, {{0, 0, 0}, 1e4}, {{0.5, 0, -0.5}, 1}, {{1000, -700, 500}, 100}};
  for (const auto& centre_and_radius : spheres) {
    const auto& [centre, radius] = centre_and_radius;
    INFO("radius ", centre_and_radius.second);
    const test::TestScene scene = sphere(centre, radius);
    const test::DeviceScene device_scene = test::upload(device, scene);
    const auto triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
    std::vector<Query> queries;
    for (int i = 0; i < 200000; ++i) {
      const auto triangle = [&] { return random.bits() % triangle_count; };
      // Two points on the same triangle have nothing between them but that triangle itself: no question for a chord.
      Query query = {.triangles = {triangle(), triangle()},
                     .points = {{uniform(), uniform()}, {uniform(), uniform()}},
                     .direction = {uniform(), uniform()},
                     .flatness = i % 2 == 0 ? 1.0f : 1e-3f,
                     .padding = 0.0f};
      if (query.triangles[0] == query.triangles[1]) query.triangles[1] = (query.triangles[1] + 1000) % triangle_count;
      queries.push_back(query);
    }
    const std::vector<std::uint32_t> answers = test::answer_queries(
        device, device_scene, leaving_rays, "leaving rays", queries, std::vector<std::uint32_t>(queries.size(), 8u));

    int unanswered = 0, itself = 0, escaped = 0, occluded = 0;
    for (const std::uint32_t answer : answers) {
      unanswered += (answer & 8u) != 0;
      itself += (answer & 1u) != 0;
      escaped += (answer & 2u) != 0;
      occluded += (answer & 4u) != 0;
    }
    CHECK(unanswered == 0);
    CHECK(itself == 0);
    CHECK(escaped == 0);
    CHECK(occluded == 0);
  }
}
