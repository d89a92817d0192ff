#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "tests/shaders/function_kernel.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

glm::dvec3 in_cube(test::RandomSource& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
  return {x, y, random.uniform(-1, 1)};
}

glm::dvec3 direction(test::RandomSource& random) {
  for (;;) {
    const glm::dvec3 v = in_cube(random);
    if (glm::dot(v, v) > 0.01 && glm::dot(v, v) < 1.0) return glm::normalize(v);
  }
}

void append(std::vector<float>& values, const glm::vec3& v) { values.insert(values.end(), {v.x, v.y, v.z}); }

glm::dvec3 vector_at(const std::vector<float>& values, std::size_t index) {
  return {values[index], values[index + 1], values[index + 2]};
}

const std::string triangle_of_row = R"(
    TriangleVertices triangle;
    triangle.a = vec3(input_float(0), input_float(1), input_float(2));
    triangle.b = vec3(input_float(3), input_float(4), input_float(5));
    triangle.c = vec3(input_float(6), input_float(7), input_float(8));
)";

}  // namespace

TANDEM_DEVICE_TEST("make_frame gives right-handed orthonormal frames for all normals") {
  test::RandomSource random(1);
  std::vector<float> normals = {0, 0, 1, 0, 0, -1, 1, 0, 0, 0, -1, 0, 1e-20f, 0, -1, 0, 1e-7f, -1};
  for (int i = 0; i < 100000; ++i) append(normals, direction(random));
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"geometry/frame.glsl\"",
                                                .body = R"(
    vec3 normal = vec3(input_float(0), input_float(1), input_float(2));
    Frame f = make_frame(normal);
    output_float(0, det_dot(f.tangent, f.bitangent));
    output_float(1, det_dot(f.tangent, f.normal));
    output_float(2, det_dot(f.bitangent, f.normal));
    output_float(3, det_length(f.tangent) - 1.0);
    output_float(4, det_length(f.bitangent) - 1.0);
    output_float(5, det_dot(det_cross(f.tangent, f.bitangent), f.normal) - 1.0);
    output_float(6, det_length(to_local(f, to_world(f, vec3(0.36, 0.48, 0.8))) - vec3(0.36, 0.48, 0.8)));)",
                                                .input_count = 3,
                                                .output_count = 7},
                                               normals);
  double worst = 0.0;
  for (const float error : outputs) worst = std::max(worst, std::abs(double{error}));
  // The normals themselves are rounded; a handful of roundings of 6e-8 follow.
  CHECK(worst < 8e-7);
}

TANDEM_DEVICE_TEST("A hit point is where the ray meets the triangle") {
  test::RandomSource random(2);
  std::vector<float> inputs;
  std::vector<glm::dvec3> exact;
  while (exact.size() < 50000) {
    const glm::vec3 a = in_cube(random), b = in_cube(random), c = in_cube(random), origin = 3.0 * in_cube(random);
    const glm::dvec3 normal = glm::cross(glm::dvec3(b - a), glm::dvec3(c - a));
    double u = random.uniform(0, 1), v = random.uniform(0, 1);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const glm::dvec3 target = glm::dvec3(a) + u * glm::dvec3(b - a) + v * glm::dvec3(c - a);
    const glm::vec3 direction = glm::normalize(target - glm::dvec3(origin));
    // Slivers and grazing rays have no well-defined hit point; they must only be finite, see below.
    if (glm::length(normal) < 0.1 || std::abs(glm::dot(glm::normalize(normal), glm::dvec3(direction))) < 0.1) continue;
    // The rounded direction meets the plane a little beside the target.
    const double t = glm::dot(glm::dvec3(a) - glm::dvec3(origin), normal) / glm::dot(glm::dvec3(direction), normal);
    exact.push_back(glm::dvec3(origin) + t * glm::dvec3(direction));
    for (const glm::vec3& point : {a, b, c, origin, direction}) append(inputs, point);
  }
  const std::vector<float> points = test::run(device,
                                              {.includes = "#include \"geometry/triangle.glsl\"",
                                               .body = triangle_of_row + R"(
    vec3 origin = vec3(input_float(9), input_float(10), input_float(11));
    vec3 direction = vec3(input_float(12), input_float(13), input_float(14));
    vec3 point = barycentric_point(triangle, hit_barycentrics(triangle, origin, direction));
    output_float(0, point.x); output_float(1, point.y); output_float(2, point.z);)",
                                               .input_count = 15,
                                               .output_count = 3},
                                              inputs);
  double worst = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
    worst = std::max(worst, glm::length(vector_at(points, 3 * i) - exact[i]));
  // Distances of 5, rounded at 6e-8 a few times, magnified by an area of 0.1 and a cosine of 0.1 at the worst.
  CHECK(worst < 2e-4);
  CHECK(worst > 0.0);
}

TANDEM_DEVICE_TEST(
    "Degenerate triangles and rays in their plane give finite points, barycentrics inside and unit normals") {
  const glm::vec3 o(0), x(1, 0, 0), y(0, 1, 0), x2(2, 0, 0), tiny(1e-30f, 0, 0), huge(1e25f, 1e25f, 0);
  const std::array<std::array<glm::vec3, 5>, 9> cases = {{
      {o, o, o, y, -y},   // a point
      {x, x, x, o, x},    // a point elsewhere
      {o, x, x2, y, -y},  // a segment
      {o, x, y, -x, x},   // a ray in the plane
      {o, tiny, y, {0, 0, 1}, {0, 0, -1}},
      {o, tiny, {0, 1e-30f, 0}, {0, 0, 1}, {0, 0, -1}},
      {o, huge, {-1e25f, 1e25f, 0}, {0, 1, 1}, {0, 0, -1}},
      {o, x, y, {0.25f, 0.25f, 0}, {0, 0, 1}},  // origin on the triangle
      {o, x, y, {5, 5, 1}, {0, 0, -1}},         // outside, as rounding may say
  }};
  std::vector<float> inputs;
  for (const auto& row : cases)
    for (const glm::vec3& point : row) append(inputs, point);
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"geometry/triangle.glsl\"",
                                                .body = triangle_of_row + R"(
    vec3 origin = vec3(input_float(9), input_float(10), input_float(11));
    vec3 direction = vec3(input_float(12), input_float(13), input_float(14));
    vec2 b = hit_barycentrics(triangle, origin, direction);
    vec3 p = barycentric_point(triangle, b);
    output_float(0, p.x); output_float(1, p.y); output_float(2, p.z); output_float(3, b.x); output_float(4, b.y);
    output_float(5, det_length(triangle_normal(triangle, -direction)));)",
                                                .input_count = 15,
                                                .output_count = 6},
                                               inputs);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const float* out = &outputs[6 * i];
    INFO("case ", i);
    for (int k = 0; k < 5; ++k) CHECK(std::isfinite(out[k]));
    CHECK(out[3] >= 0.0f);
    CHECK(out[4] >= 0.0f);
    CHECK(out[3] + out[4] <= 1.0f);
    CHECK(out[5] == doctest::Approx(1.0).epsilon(1e-6));
  }
}

TANDEM_DEVICE_TEST("An offset point is on its side of the surface, and close, at every scale") {
  test::RandomSource random(3);
  std::vector<float> inputs;
  std::vector<double> scales;
  for (int exponent = -6; exponent <= 6; ++exponent) {
    const double scale = std::pow(10.0, exponent);
    for (int i = 0; i < 4000; ++i) {
      std::array<glm::dvec3, 3> corners = {in_cube(random), in_cube(random), in_cube(random)};
      const int kind = i % 4;
      if (kind == 1) corners = {in_cube(random) * 0.01, in_cube(random) * 0.01, in_cube(random) * 0.01};
      if (kind == 2)
        for (glm::dvec3& corner : corners) corner.y = 0.0;  // a floor through the origin
      if (kind == 3)
        for (glm::dvec3& corner : corners) corner = corner * 0.05 + glm::dvec3(1.0, -0.7, 0.9);  // far from the origin
      const glm::dvec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
      const double longest = std::max({glm::length(corners[1] - corners[0]), glm::length(corners[2] - corners[0]),
                                       glm::length(corners[2] - corners[1])});
      // The float normal of a sliver is any direction.
      if (glm::length(cross) < 0.1 * longest * longest) continue;
      for (const glm::dvec3& corner : corners) append(inputs, corner * scale);
      const double u = random.uniform(0, 1), v = random.uniform(0, 1);
      inputs.insert(inputs.end(), {static_cast<float>(u), static_cast<float>(v * (1 - u))});
      scales.push_back(scale);
    }
  }
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"geometry/triangle.glsl\"\n"
                                                            "#include \"geometry/offset_ray.glsl\"",
                                                .body = triangle_of_row + R"(
    vec3 point = barycentric_point(triangle, vec2(input_float(9), input_float(10)));
    vec3 normal = triangle_normal(triangle, vec3(0.0));
    float distance = offset_distance(point, normal, triangle_extent(triangle));
    vec3 above = offset_point(point, normal, distance, normal);
    vec3 below = offset_point(point, normal, distance, -normal);
    output_float(0, above.x); output_float(1, above.y); output_float(2, above.z);
    output_float(3, below.x); output_float(4, below.y); output_float(5, below.z);)",
                                                .input_count = 11,
                                                .output_count = 6},
                                               inputs);
  double nearest = 1.0, farthest = 0.0;
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const glm::dvec3 a = vector_at(inputs, 11 * i);
    const glm::dvec3 normal =
        glm::normalize(glm::cross(vector_at(inputs, 11 * i + 3) - a, vector_at(inputs, 11 * i + 6) - a));
    const double above = glm::dot(vector_at(outputs, 6 * i) - a, normal) / scales[i];
    const double below = glm::dot(vector_at(outputs, 6 * i + 3) - a, normal) / scales[i];
    nearest = std::min({nearest, above, -below});
    farthest = std::max({farthest, above, -below});
  }
  CHECK(nearest > 0.0);
  // 32 ULP of a sum of three coordinates below 1 (an ULP there is at most 2.4e-7), and the rounding of the point.
  CHECK(farthest < 40 * 2.4e-7);
}
