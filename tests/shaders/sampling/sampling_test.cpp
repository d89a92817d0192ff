#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "tests/shaders/function_kernel.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

constexpr int grid_size = 1000;

/// The centres of a grid over the unit square: averages over them are midpoint integrals.
std::vector<float> unit_square_grid() {
  std::vector<float> points;
  for (int y = 0; y < grid_size; ++y)
    for (int x = 0; x < grid_size; ++x)
      points.insert(points.end(),
                    {(static_cast<float>(x) + 0.5f) / grid_size, (static_cast<float>(y) + 0.5f) / grid_size});
  return points;
}

// Roots have an infinite slope at 0, which costs a midpoint rule of spacing h accuracy: the error is of the order of
// h^(3/2) = 3e-5 rather than h^2.
constexpr double integral_tolerance = 1e-4;

}  // namespace

TANDEM_DEVICE_TEST("cosine_hemisphere gives unit vectors with the moments of cos / pi") {
  const std::vector<float> directions = test::run(device,
                                                  {.includes = "#include \"sampling/hemisphere.glsl\"",
                                                   .body = R"(
    vec3 w = cosine_hemisphere(vec2(input_float(0), input_float(1)));
    output_float(0, w.x); output_float(1, w.y); output_float(2, w.z);)",
                                                   .input_count = 2,
                                                   .output_count = 3},
                                                  unit_square_grid());
  double x = 0, y = 0, z = 0, xx = 0, yy = 0, zz = 0, xy = 0, z4 = 0, worst_length = 0, lowest = 1;
  for (std::size_t i = 0; i < directions.size(); i += 3) {
    const double dx = directions[i], dy = directions[i + 1], dz = directions[i + 2];
    x += dx;
    y += dy;
    z += dz;
    xx += dx * dx;
    yy += dy * dy;
    zz += dz * dz;
    xy += dx * dy;
    z4 += dz * dz * dz * dz;
    worst_length = std::max(worst_length, std::abs(std::sqrt(dx * dx + dy * dy + dz * dz) - 1.0));
    lowest = std::min(lowest, dz);
  }
  const double count = double{grid_size} * grid_size;
  const auto close = [](double a, double b) { return std::abs(a - b) < integral_tolerance; };
  CHECK(close(x / count, 0.0));
  CHECK(close(y / count, 0.0));
  CHECK(close(z / count, 2.0 / 3.0));
  CHECK(close(xx / count, 0.25));
  CHECK(close(yy / count, 0.25));
  CHECK(close(zz / count, 0.5));
  CHECK(close(xy / count, 0.0));
  CHECK(close(z4 / count, 1.0 / 3.0));
  CHECK(lowest >= 0.0);
  // Some five roundings of at most 2^-24 each.
  CHECK(worst_length < 3e-7);
}

TANDEM_DEVICE_TEST("cosine_hemisphere is defined on the edges and diagonals of the unit square") {
  std::vector<float> inputs;
  const float last = 0x1.fffffep-1f;
  for (const float u : {0.0f, 0.25f, 0.5f, 0.75f, last})
    for (const float v : {0.0f, 0.25f, 0.5f, 0.75f, last}) inputs.insert(inputs.end(), {u, v});
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"sampling/hemisphere.glsl\"",
                                                .body = R"(
    vec3 w = cosine_hemisphere(vec2(input_float(0), input_float(1)));
    output_float(0, det_length(w)); output_float(1, w.z);)",
                                                .input_count = 2,
                                                .output_count = 2},
                                               inputs);
  for (std::size_t i = 0; i < outputs.size(); i += 2) {
    CHECK(outputs[i] == doctest::Approx(1.0).epsilon(1e-6));
    CHECK(outputs[i + 1] >= 0.0f);
  }
}

TANDEM_DEVICE_TEST("uniform_triangle gives the moments of a uniform distribution, inside") {
  const std::vector<float> points = test::run(device,
                                              {.includes = "#include \"sampling/triangle.glsl\"",
                                               .body = R"(
    vec2 b = uniform_triangle(vec2(input_float(0), input_float(1)));
    output_float(0, b.x); output_float(1, b.y);)",
                                               .input_count = 2,
                                               .output_count = 2},
                                              unit_square_grid());
  double b = 0, c = 0, bb = 0, cc = 0, bc = 0;
  bool inside = true;
  for (std::size_t i = 0; i < points.size(); i += 2) {
    const double x = points[i], y = points[i + 1];
    b += x;
    c += y;
    bb += x * x;
    cc += y * y;
    bc += x * y;
    inside = inside && x >= 0.0 && y >= 0.0 && x + y <= 1.0 + 1e-7;
  }
  const double count = double{grid_size} * grid_size;
  const auto close = [](double x, double y) { return std::abs(x - y) < integral_tolerance; };
  CHECK(close(b / count, 1.0 / 3.0));
  CHECK(close(c / count, 1.0 / 3.0));
  CHECK(close(bb / count, 1.0 / 6.0));
  CHECK(close(cc / count, 1.0 / 6.0));
  CHECK(close(bc / count, 1.0 / 12.0));
  CHECK(inside);
}

TANDEM_DEVICE_TEST("An alias table gives each entry its probability") {
  // Entries 0, 1, 2 with the probabilities 1/2, 1/3, 1/6: columns of height 1/3, of which entry 2 fills half and entry
  // 1 all of its own.
  test::RandomSource random(2);
  std::vector<std::uint32_t> inputs;
  const std::size_t draws = 1 << 20;
  for (std::size_t i = 0; i < 2 * draws; ++i) inputs.push_back(random.bits());
  const std::vector<std::uint32_t> chosen = test::run_bits(device,
                                                           {.includes = "#include \"sampling/alias_table.glsl\"",
                                                            .body = R"(
    uint index = uniform_index(input_bits(0), 3u);
    uint threshold = index == 2u ? 0x80000000u : 0xffffffffu;
    uint alias = index == 2u ? 0u : index;
    output_bits(0, alias_choice(index, alias, threshold, input_bits(1)));)",
                                                            .input_count = 2},
                                                           inputs);
  std::vector<double> counts(3);
  for (const std::uint32_t entry : chosen) {
    REQUIRE(entry < 3);
    counts[entry] += 1.0;
  }
  // Five standard deviations of a binomial count: 5 * sqrt(p (1 - p) / n) < 0.0025.
  CHECK(std::abs(counts[0] / draws - 1.0 / 2.0) < 0.0025);
  CHECK(std::abs(counts[1] / draws - 1.0 / 3.0) < 0.0025);
  CHECK(std::abs(counts[2] / draws - 1.0 / 6.0) < 0.0025);
}

TANDEM_DEVICE_TEST("uniform_index covers its range and no more") {
  const test::FunctionKernel kernel = {.includes = "#include \"sampling/alias_table.glsl\"",
                                       .body = "output_bits(0, uniform_index(input_bits(0), input_bits(1)));",
                                       .input_count = 2};
  const std::vector<std::uint32_t> outputs = test::run_bits(
      device, kernel,
      {0u, 1u, 0xffffffffu, 1u, 0u, 7u, 0xffffffffu, 7u, 0x80000000u, 2u, 0x7fffffffu, 2u, 0xffffffffu, 0xffffffffu});
  CHECK(outputs == std::vector<std::uint32_t>{0u, 0u, 0u, 6u, 1u, 0u, 0xfffffffeu});
}
