#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "tests/shaders/function_kernel.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

/// `expression` of `point` at each point.
std::vector<float> at_points(rhi::Device& device, const std::vector<glm::vec3>& points, const std::string& expression) {
  std::vector<float> inputs;
  for (const glm::vec3& point : points) inputs.insert(inputs.end(), {point.x, point.y, point.z});
  return test::run(device,
                   {.includes = "#include \"texture/noise.glsl\"",
                    .body = "vec3 point = vec3(input_float(0), input_float(1), input_float(2)); output_float(0, " +
                            expression + ");",
                    .input_count = 3,
                    .output_count = 1},
                   inputs);
}

std::vector<glm::vec3> random_points(int count, double extent, std::uint32_t seed) {
  test::RandomSource random(seed);
  std::vector<glm::vec3> points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-extent, extent), y = random.uniform(-extent, extent);
    points.emplace_back(x, y, random.uniform(-extent, extent));
  }
  return points;
}

}  // namespace

TANDEM_DEVICE_TEST("Gradient noise is 0 at the lattice, bounded, smooth and 0 on average") {
  std::vector<glm::vec3> lattice;
  for (int x = -3; x < 3; ++x)
    for (int y = -3; y < 3; ++y)
      for (int z = -3; z < 3; ++z) lattice.emplace_back(x, y, z);
  for (const float value : at_points(device, lattice, "gradient_noise(point)")) REQUIRE(value == 0.0f);

  constexpr int count = 200000;
  const std::vector<glm::vec3> points = random_points(count, 100, 51);
  const std::vector<float> values = at_points(device, points, "gradient_noise(point)");
  double sum = 0, squares = 0, largest = 0;
  for (const float value : values) {
    sum += double{value};
    squares += double{value} * double{value};
    largest = std::max(largest, std::abs(double{value}));
  }
  const double deviation = std::sqrt(squares / count);
  // Points are independent but for those in one cell of 8 million; five standard errors.
  CHECK(std::abs(sum / count) < 5 * deviation / std::sqrt(count));
  CHECK(largest <= 1.04);
  // Twelve gradients of length sqrt(2): the variance at a cell's centre is 2 / 3 * 3 / 4 / 8 = 1 / 16 and less
  // elsewhere.
  CHECK(deviation > 0.15);
  CHECK(deviation < 0.35);

  const std::vector<float> neighbours =
      at_points(device, points, "gradient_noise(point + vec3(0.0078125, -0.0078125, 0.0078125))");
  double steepest = 0, correlation = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    steepest = std::max(steepest, std::abs(double{values[i]} - double{neighbours[i]}));
  // The slope along an axis is at most some 4 (2 from fading between gradients, 1.875 at the steepest, and 1 their
  // own).
  CHECK(steepest < 3 * 4 * 0.0078125);
  CHECK(steepest > 0.0078125);
  const std::vector<float> far = at_points(device, points, "gradient_noise(point + vec3(2.25, 1.75, -3.5))");
  for (std::size_t i = 0; i < values.size(); ++i) correlation += double{values[i]} * double{far[i]};
  CHECK(std::abs(correlation / squares) < 5 / std::sqrt(count));
}

TANDEM_DEVICE_TEST("Noise has no direction and no cell of its own") {
  constexpr int count = 100000;
  const std::vector<glm::vec3> points = random_points(count, 50, 52);
  // The same points of the cell in other cells, along each axis: equal variance.
  double squares[3] = {};
  const char* planes[3] = {"vec3(floor(point.x) + 0.5, point.yz)", "vec3(point.x, floor(point.y) + 0.5, point.z)",
                           "vec3(point.xy, floor(point.z) + 0.5)"};
  for (int axis = 0; axis < 3; ++axis)
    for (const float value : at_points(device, points, std::string("gradient_noise(") + planes[axis] + ")"))
      squares[axis] += double{value} * double{value} / count;
  // The variance of a square is at most twice the square of the variance (normal values), so five standard errors of a
  // difference of two means are 5 * 2 / sqrt(count) of it, or 3.2 %.
  CHECK(squares[0] == doctest::Approx(squares[1]).epsilon(0.04));
  CHECK(squares[0] == doctest::Approx(squares[2]).epsilon(0.04));
}

TANDEM_DEVICE_TEST("Turbulence is in [0, 1] wherever a point is") {
  std::vector<glm::vec3> points = random_points(100000, 20, 53);
  for (const float far : {1e6f, 1e10f, 1e30f, 3e38f, -3e38f, 1e-30f, -1e-38f}) points.emplace_back(far, -far, far);
  double sum = 0;
  for (const float value : at_points(device, points, "turbulence(point)")) {
    REQUIRE(value >= 0.0f);
    REQUIRE(value <= 1.0f);
    sum += double{value};
  }
  // Magnitudes of noise with a deviation of a quarter: some 0.2 in the mean, twice that for all octaves.
  CHECK(sum / double(points.size()) > 0.2);
  CHECK(sum / double(points.size()) < 0.6);
}
