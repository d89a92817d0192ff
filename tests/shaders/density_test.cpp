// Samples of directions against the densities that are claimed for them, and those against their formulas.

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/shaders/function_kernel.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/statistics/chi_square.hpp"

using namespace tandem;

namespace {

/// A distribution over the hemisphere that depends on the cosine only.
struct Distribution {
  std::string name;
  std::string include;
  std::string sample;    ///< GLSL, of vec2 u
  std::string density;   ///< GLSL, of float cosine
  double factor, power;  ///< the density is factor * cosine^power
};

const std::vector<Distribution> distributions = {
    {"uniform", "sampling/hemisphere.glsl", "uniform_hemisphere(u)", "UNIFORM_HEMISPHERE_DENSITY",
     0.5 * std::numbers::inv_pi, 0},
    {"cosine", "sampling/hemisphere.glsl", "cosine_hemisphere(u)", "cosine_hemisphere_density(cosine)",
     std::numbers::inv_pi, 1},
    {"Phong 5", "sampling/power_cosine.glsl", "power_cosine(u, 5.0)",
     "power_cosine_density(cosine_power(cosine, 5.0), 5.0)", 3 * std::numbers::inv_pi, 5},
    {"Phong 40", "sampling/power_cosine.glsl", "power_cosine(u, 40.0)",
     "power_cosine_density(cosine_power(cosine, 40.0), 40.0)", 20.5 * std::numbers::inv_pi, 40}};

}  // namespace

TANDEM_DEVICE_TEST("Directions over the hemisphere have the densities of the lecture's formulas") {
  const test::SphereBins bins{.rows = 16, .columns = 16, .lowest = 0};
  constexpr std::uint32_t count = 1 << 16;
  constexpr std::size_t side = 8;
  const std::vector<glm::dvec3> nodes = bins.nodes(side);
  for (const Distribution& distribution : distributions) {
    CAPTURE(distribution.name);
    const std::string include = "#include \"random.glsl\"\n#include \"" + distribution.include + "\"";
    std::vector<std::uint32_t> indices(count);
    for (std::uint32_t i = 0; i < count; ++i) indices[i] = i;
    const std::vector<std::uint32_t> samples = test::run_bits(device,
                                                              {.includes = include,
                                                               .body = R"(
    RandomKey key;
    key.pixel = input_bits(0);
    key.sample_index = 0;
    key.seed = 11;
    uvec4 bits = random_bits(key, 0);
    vec2 u = vec2(unit_interval(bits.x), unit_interval(bits.y));
    vec3 w = )" + distribution.sample + R"(;
    output_float(0, w.x); output_float(1, w.y); output_float(2, w.z);)",
                                                               .output_count = 3},
                                                              indices);
    std::vector<double> counts(bins.count());
    double worst_length = 0;
    for (std::size_t i = 0; i < samples.size(); i += 3) {
      const glm::dvec3 direction(std::bit_cast<float>(samples[i]), std::bit_cast<float>(samples[i + 1]),
                                 std::bit_cast<float>(samples[i + 2]));
      counts[bins.bin(direction)] += 1;
      worst_length = std::max(
          worst_length,
          std::abs(std::sqrt(direction.x * direction.x + direction.y * direction.y + direction.z * direction.z) - 1));
    }
    CHECK(worst_length < 5e-7);  // some eight roundings

    std::vector<float> cosines;
    for (const glm::dvec3& node : nodes) cosines.push_back(static_cast<float>(node.z));
    const std::vector<float> densities = test::run(
        device,
        {.includes = include, .body = "float cosine = input_float(0); output_float(0, " + distribution.density + ");"},
        cosines);
    double worst = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double exact = distribution.factor * std::pow(double{cosines[i]}, distribution.power);
      // Powers below 1e-20 are none.
      if (exact > 1e-19) worst = std::max(worst, std::abs(double{densities[i]} / exact - 1));
    }
    CHECK(worst < 1e-6);  // a power of 2 ULP and three roundings

    const std::vector<double> integrals = bins.integrals(std::vector<double>(densities.begin(), densities.end()));
    double total = 0;
    for (const double integral : integrals) total += integral;
    // The midpoint rule with 128 heights: (41 / 128)^2 / 24 = 0.004 for the power of 40.
    CHECK(total == doctest::Approx(1.0).epsilon(0.006));
    std::vector<double> exact;
    for (std::size_t row = 0; row < bins.rows; ++row) {
      const auto below = [&](double z) { return std::pow(z, distribution.power + 1); };
      const double rows = static_cast<double>(bins.rows), index = static_cast<double>(row);
      exact.insert(exact.end(), bins.columns, below((index + 1) / rows) - below(index / rows));
    }
    CHECK(test::chi_square(counts, exact).p_value > 1e-3);  // the samples are fixed
  }
}

TANDEM_DEVICE_TEST("concentric_disk is uniform over the unit disk") {
  constexpr std::uint32_t count = 1 << 16, side = 16;
  std::vector<std::uint32_t> indices(count);
  for (std::uint32_t i = 0; i < count; ++i) indices[i] = i;
  const std::vector<std::uint32_t> points = test::run_bits(device,
                                                           {.includes = R"(#include "random.glsl"
#include "sampling/hemisphere.glsl")",
                                                            .body = R"(
    RandomKey key;
    key.pixel = input_bits(0);
    key.sample_index = 0;
    key.seed = 12;
    uvec4 bits = random_bits(key, 0);
    vec3 p = concentric_disk(vec2(unit_interval(bits.x), unit_interval(bits.y)));
    output_float(0, p.x); output_float(1, p.y); output_float(2, p.z);)",
                                                            .output_count = 3},
                                                           indices);
  std::vector<double> counts(side * side);
  double worst_radius = 0;
  for (std::size_t i = 0; i < points.size(); i += 3) {
    const double x = double{std::bit_cast<float>(points[i])}, y = double{std::bit_cast<float>(points[i + 1])};
    const double squared_radius = x * x + y * y;
    worst_radius = std::max(
        worst_radius, std::abs(std::sqrt(squared_radius) - std::abs(double{std::bit_cast<float>(points[i + 2])})));
    // Rings of equal area, and angles.
    const double turn = std::atan2(y, x) / (2 * std::numbers::pi) + 0.5;
    counts[test::unit_interval_bin(squared_radius, side) * side + test::unit_interval_bin(turn, side)] += 1;
  }
  CHECK(worst_radius < 5e-7);
  CHECK(test::chi_square_uniform(counts).p_value > 1e-3);
}
