#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "tests/shaders/function_kernel.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

glm::dvec3 direction(test::RandomSource& random) {
  for (;;) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const glm::dvec3 v(x, y, z);
    if (glm::dot(v, v) > 0.01 && glm::dot(v, v) < 1.0) return glm::normalize(v);
  }
}

void append(std::vector<float>& values, const glm::vec3& v) { values.insert(values.end(), {v.x, v.y, v.z}); }

glm::dvec3 vector_at(const std::vector<float>& values, std::size_t index) {
  return {values[index], values[index + 1], values[index + 2]};
}

const std::string sphere_of_row = R"(
    vec3 centre = vec3(input_float(0), input_float(1), input_float(2));
    float radius = input_float(3);
    vec3 origin = vec3(input_float(4), input_float(5), input_float(6));
    vec3 direction = vec3(input_float(7), input_float(8), input_float(9));
)";

/// A ray and a sphere.
struct Case {
  glm::vec3 centre;
  float radius;
  glm::vec3 origin;
  glm::vec3 direction;
};

/// x: where the ray enters, y: where it leaves, per case.
std::vector<glm::vec2> roots_of(rhi::Device& device, const std::vector<Case>& cases) {
  std::vector<float> inputs;
  for (const Case& c : cases) {
    append(inputs, c.centre);
    inputs.push_back(c.radius);
    append(inputs, c.origin);
    append(inputs, c.direction);
  }
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"geometry/sphere.glsl\"",
                                                .body = sphere_of_row + R"(
    vec2 roots = sphere_roots(centre, radius, origin, direction);
    output_float(0, roots.x);
    output_float(1, roots.y);)",
                                                .input_count = 10,
                                                .output_count = 2},
                                               inputs);
  std::vector<glm::vec2> roots;
  for (std::size_t i = 0; i < outputs.size(); i += 2) roots.emplace_back(outputs[i], outputs[i + 1]);
  return roots;
}

constexpr glm::vec2 missed(-1, -1);

}  // namespace

TANDEM_DEVICE_TEST("Rays enter and leave spheres where they should") {
  const glm::vec3 o(0), x(1, 0, 0), y(0, 1, 0);
  const std::vector<Case> cases = {
      {o, 1, -3.0f * x, x},                       // through the centre
      {o, 1, -3.0f * x, 2.0f * x},                // the same, counted in lengths of the direction
      {o, 1, o, y},                               // from the centre
      {o, 1, 3.0f * x, x},                        // behind
      {o, 1, {-3, 0.5f, 0}, x},                   // aside
      {o, 1, {-3, 1, 0}, x},                      // touching
      {o, 1, {-3, 1.0001f, 0}, x},                // passing by
      {o, 0, {-3, 1, 0}, x},                      // no radius
      {o, 1, -3.0f * x, o},                       // no direction
      {{1e6f, 0, 0}, 1, {1e6f - 3.0f, 0, 0}, x},  // far from the origin of coordinates
      {{0, -1000, 0}, 1000, {0, 2, 0}, -y},       // a ground
      {o, 1e-6f, -1e-3f * x, x},
      {o, 1e15f, 2e15f * x, -x},
  };
  const std::vector<glm::vec2> expected = {{2, 4},
                                           {1, 2},
                                           {-1, 1},
                                           {-4, -2},
                                           {3 - std::sqrt(0.75f), 3 + std::sqrt(0.75f)},
                                           {3, 3},
                                           missed,
                                           missed,
                                           missed,
                                           {2, 4},
                                           {2, 2002},
                                           {0.000999f, 0.001001f},
                                           {1e15f, 3e15f}};
  const std::vector<glm::vec2> roots = roots_of(device, cases);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    INFO("case ", i);
    // A few roundings; of the ground's first root that of a square of 1000 before its difference with another.
    const double tolerance = cases[i].radius == 1000 ? 1e-4 : 1e-6;
    CHECK(roots[i].x == doctest::Approx(expected[i].x).epsilon(tolerance));
    CHECK(roots[i].y == doctest::Approx(expected[i].y).epsilon(tolerance));
  }
}

TANDEM_DEVICE_TEST("Which rays meet a sphere, and where, agrees with double precision at every scale and distance") {
  test::RandomSource random(7);
  std::vector<Case> cases;
  for (const double scale : {1e-9, 1e-3, 1.0, 1e3, 1e9})
    for (const double distance : {0.0, 0.9, 1.1, 3.0, 100.0, 10000.0})
      for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 centre = scale * random.uniform(0, 3) * direction(random);
        const double radius = scale * random.uniform(0.5, 1.5);
        const glm::dvec3 origin = centre + distance * radius * direction(random);
        // Aimed at a point at up to 1.2 radii from the centre, and any length.
        const glm::dvec3 target = centre + 1.2 * radius * std::sqrt(random.uniform(0, 1)) * direction(random);
        const double length = random.uniform(0.25, 4) * (i % 2 == 0 ? 1 : scale);
        if (glm::distance(target, origin) < 1e-3 * radius) continue;
        cases.push_back({centre, static_cast<float>(radius), origin, length * glm::normalize(target - origin)});
      }
  const std::vector<glm::vec2> roots = roots_of(device, cases);
  int hits = 0, wrong = 0;
  double worst = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    const glm::dvec3 f = glm::dvec3(c.origin) - glm::dvec3(c.centre), d(c.direction);
    const double a = glm::dot(d, d), b = glm::dot(f, d), r = c.radius;
    const glm::dvec3 closest = f - d * (b / a);
    // What float arithmetic may move the ray by: a few units in the last place of the largest coordinate.
    const double blur = 8 * 0x1p-24 * (glm::length(glm::dvec3(c.origin)) + glm::length(f) + r);
    const double passing = glm::length(closest);
    if (std::abs(passing - r) <= blur) continue;
    const bool hit = passing < r;
    wrong += hit != (roots[i] != missed);
    if (!hit || roots[i] == missed) continue;
    ++hits;
    const double half = std::sqrt(r * r - passing * passing) / std::sqrt(a);
    // A sideways blur moves the roots by its multiple with the sphere's slope there.
    const double slope = r / std::sqrt(r * r - passing * passing);
    const double tolerance = blur * slope / std::sqrt(a);
    for (const double error : {roots[i].x - (-b / a - half), roots[i].y - (-b / a + half)})
      worst = std::max(worst, std::abs(error) / tolerance);
  }
  CHECK(wrong == 0);
  CHECK(hits > 30000);
  CHECK(worst < 1);
  CHECK(worst > 0.01);
}

TANDEM_DEVICE_TEST("A hit's position is on the sphere and on the ray, and its normal has length 1") {
  test::RandomSource random(8);
  std::vector<Case> cases;
  for (const double scale : {1e-6, 1.0, 1e6})
    for (int i = 0; i < 10000; ++i) {
      const glm::dvec3 centre = scale * random.uniform(0, 3) * direction(random);
      const double radius = scale * random.uniform(0.5, 1.5);
      const glm::dvec3 outwards = direction(random);
      const glm::dvec3 origin = centre + radius * random.uniform(1.5, 5) * outwards;
      const glm::dvec3 target = centre + radius * glm::normalize(outwards + 0.6 * direction(random));
      cases.push_back({centre, static_cast<float>(radius), origin, glm::normalize(target - origin)});
    }
  std::vector<float> inputs;
  for (const Case& c : cases) {
    append(inputs, c.centre);
    inputs.push_back(c.radius);
    append(inputs, c.origin);
    append(inputs, c.direction);
  }
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"geometry/sphere.glsl\"",
                                                .body = sphere_of_row + R"(
    vec3 normal = sphere_normal(centre, origin, direction, sphere_roots(centre, radius, origin, direction).x);
    vec3 position = centre + normal * radius;
    output_float(0, position.x); output_float(1, position.y); output_float(2, position.z);
    output_float(3, normal.x); output_float(4, normal.y); output_float(5, normal.z);)",
                                                .input_count = 10,
                                                .output_count = 6},
                                               inputs);
  double off_sphere = 0, off_ray = 0, off_length = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    const glm::dvec3 position = vector_at(outputs, 6 * i), normal = vector_at(outputs, 6 * i + 3);
    const glm::dvec3 from_origin = position - glm::dvec3(c.origin), d = glm::normalize(glm::dvec3(c.direction));
    off_sphere = std::max(off_sphere, std::abs(glm::distance(position, glm::dvec3(c.centre)) - c.radius) / c.radius);
    off_ray = std::max(off_ray, glm::length(from_origin - glm::dot(from_origin, d) * d) / c.radius);
    off_length = std::max(off_length, std::abs(glm::length(normal) - 1));
  }
  // Coordinates of up to 9 radii, rounded at 6e-8 a few times.
  CHECK(off_sphere < 1.5e-6);
  CHECK(off_ray < 1.5e-6);
  CHECK(off_length < 2.5e-7);  // det_normalize: 2 ULP
}

TANDEM_DEVICE_TEST("No ray meets the sphere where it starts from it, in whatever direction") {
  test::RandomSource random(9);
  std::vector<float> inputs;
  std::vector<double> cosines;
  struct Place {
    double distance, radius;
  };
  for (const Place place : {Place{0, 1}, {3, 1}, {1000, 1}, {1000, 1000}, {0, 1e-6}, {1e-3, 1e-6}, {0, 1e9}, {1e4, 10}})
    for (int i = 0; i < 20000; ++i) {
      const glm::dvec3 centre = place.distance * direction(random), normal = direction(random);
      const glm::dvec3 origin = centre + place.radius * random.uniform(1.2, 8) * normal;
      const glm::dvec3 target = centre + place.radius * glm::normalize(normal + 0.9 * direction(random));
      append(inputs, centre);
      inputs.push_back(static_cast<float>(place.radius));
      append(inputs, origin);
      append(inputs, glm::normalize(target - origin));
      // Of the ray that leaves: every third is all but tangential.
      const glm::dvec3 leaving = direction(random);
      append(inputs, leaving);
      inputs.push_back(i % 3 == 0 ? 1e-4f : 1.0f);
    }
  const std::string body = sphere_of_row + R"(
    float entered = sphere_roots(centre, radius, origin, direction).x;
    vec3 normal = sphere_normal(centre, origin, direction, entered);
    vec3 position = centre + normal * radius;
    float offset = sphere_offset(centre, radius, normal) * OFFSET_FRACTION;
    vec3 leaving = vec3(input_float(10), input_float(11), input_float(12));
    leaving = leaving - normal * (det_dot(leaving, normal) * (1.0 - input_float(13)));
    leaving = det_normalize(leaving, normal);
    // Hits are met from a tiny t on, as in sphere_hit.
    vec2 outside = sphere_roots(centre, radius, offset_point(position, normal, offset, normal),
                                det_dot(leaving, normal) < 0.0 ? -leaving : leaving);
    vec2 inside = sphere_roots(centre, radius, offset_point(position, normal, offset, -normal),
                               det_dot(leaving, normal) < 0.0 ? leaving : -leaving);
    output_bits(0, entered > 0.0 ? 1u : 0u);
    output_bits(1, outside.x > 0.0 || outside.y > 0.0 ? 1u : 0u);
    output_bits(2, inside.x > 0.0 || !(inside.y > 0.0) ? 1u : 0u);)";
  std::vector<std::uint32_t> bits;
  for (const float input : inputs) bits.push_back(std::bit_cast<std::uint32_t>(input));
  for (const bool with_offset : {true, false}) {
    const std::vector<std::uint32_t> outputs =
        test::run_bits(device,
                       {.includes = "#include \"geometry/sphere.glsl\"\n#include \"geometry/offset_ray.glsl\"\n#define "
                                    "OFFSET_FRACTION " +
                                    std::string(with_offset ? "0.5" : "0.0"),
                        .body = body,
                        .input_count = 14,
                        .output_count = 3},
                       bits);
    std::size_t met = 0, met_again = 0, lost = 0;
    for (std::size_t i = 0; i < outputs.size(); i += 3) {
      met += outputs[i];
      met_again += outputs[i + 1];
      lost += outputs[i + 2];
    }
    CHECK(met * 3 > outputs.size() * 9 / 10);
    if (with_offset) {
      // Half of the offset is enough: the other half is margin.
      CHECK(met_again == 0);
      CHECK(lost == 0);
    } else {
      CHECK(met_again > 1000);  // without an offset this test finds something
    }
  }
}

TANDEM_DEVICE_TEST("Texture coordinates of a sphere go once around and from pole to pole") {
  std::vector<float> inputs;
  std::vector<glm::dvec2> expected;
  test::RandomSource random(10);
  const auto add = [&](const glm::dvec3& normal, double u, double v) {
    append(inputs, normal);
    expected.emplace_back(u, v);
  };
  add({1, 0, 0}, 0.5, 0.5);
  add({0, 0, 1}, 0.25, 0.5);
  add({0, 0, -1}, 0.75, 0.5);
  add({0, 1, 0}, 0.5, 1);
  add({0, -1, 0}, 0.5, 0);
  for (int i = 0; i < 10000; ++i) {
    const glm::dvec3 normal(glm::vec3(direction(random)));
    add(normal, 0.5 + std::atan2(-normal.z, normal.x) / (2 * std::numbers::pi),
        std::acos(-normal.y) / std::numbers::pi);
  }
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"geometry/sphere.glsl\"",
                                                .body = R"(
    vec2 uv = sphere_texture_coordinates(vec3(input_float(0), input_float(1), input_float(2)));
    output_float(0, uv.x);
    output_float(1, uv.y);)",
                                                .input_count = 3,
                                                .output_count = 2},
                                               inputs);
  double worst = 0;
  for (std::size_t i = 0; i < expected.size(); ++i)
    worst = std::max({worst, std::abs(outputs[2 * i] - expected[i].x), std::abs(outputs[2 * i + 1] - expected[i].y)});
  CHECK(worst < 3e-7);  // angles of 3 ULP, and a rounding or two
}

TANDEM_DEVICE_TEST("The derivatives of a sphere are how its points move with the texture coordinates") {
  test::RandomSource random(11);
  constexpr float radius = 3;
  std::vector<float> inputs;
  for (int i = 0; i < 2000; ++i) append(inputs, direction(random));
  append(inputs, {0, 1, 0});
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"geometry/sphere.glsl\"",
                                                .body = R"(
    vec3 normal = vec3(input_float(0), input_float(1), input_float(2));
    vec3 by_u = sphere_derivative_by_u(3.0, normal);
    vec3 by_v = sphere_derivative_by_v(3.0, normal);
    output_float(0, by_u.x); output_float(1, by_u.y); output_float(2, by_u.z);
    output_float(3, by_v.x); output_float(4, by_v.y); output_float(5, by_v.z);)",
                                                .input_count = 3,
                                                .output_count = 6},
                                               inputs);
  const auto point = [](double u, double v) {
    const double phi = 2 * std::numbers::pi * (u - 0.5), theta = std::numbers::pi * v;
    return double{radius} *
           glm::dvec3(std::sin(theta) * std::cos(phi), -std::cos(theta), -std::sin(theta) * std::sin(phi));
  };
  double worst = 0;
  for (std::size_t i = 0; i + 3 < inputs.size(); i += 3) {
    const glm::dvec3 normal = vector_at(inputs, i);
    const double u = 0.5 + std::atan2(-normal.z, normal.x) / (2 * std::numbers::pi);
    const double v = std::acos(-normal.y) / std::numbers::pi;
    constexpr double step = 1e-5;
    const glm::dvec3 by_u = (point(u + step, v) - point(u - step, v)) / (2 * step);
    const glm::dvec3 by_v = (point(u, v + step) - point(u, v - step)) / (2 * step);
    worst = std::max(
        {worst, glm::distance(by_u, vector_at(outputs, 2 * i)), glm::distance(by_v, vector_at(outputs, 2 * i + 3))});
  }
  // Numbers of up to 19, rounded a few times; near a pole the angle around it has fewer bits.
  CHECK(worst < 1e-4);
  for (int k = 0; k < 6; ++k) CHECK(outputs[outputs.size() - 6 + k] == 0.0f);
}
