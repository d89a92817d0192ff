#include "tests/support/statistics/chi_square.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "tests/shaders/random_source.hpp"

using namespace tandem;

namespace {

std::vector<double> binned(test::RandomSource& random, std::size_t samples, std::size_t bins, double power) {
  std::vector<double> counts(bins);
  for (std::size_t i = 0; i < samples; ++i)
    counts[test::unit_interval_bin(std::pow(random.uniform(0, 1), power), bins)] += 1;
  return counts;
}

}  // namespace

TEST_CASE("p-values of samples with the right density are uniform") {
  test::RandomSource random(1);
  std::vector<double> p_values(10);
  for (int i = 0; i < 1000; ++i) {
    const double p = test::chi_square_uniform(binned(random, 1000, 20, 1.0)).p_value;
    p_values[test::unit_interval_bin(p, p_values.size())] += 1;
  }
  // The seed is fixed; one seed in a thousand would fail.
  CHECK(test::chi_square_uniform(p_values).p_value > 1e-3);
}

TEST_CASE("Samples with another density are found out") {
  test::RandomSource random(2);
  // u^1.05 has the density 0.952 x^-0.048, which is within 5 % of 1 over most of the interval.
  CHECK(test::chi_square_uniform(binned(random, 100'000, 20, 1.05)).p_value < 1e-6);
  std::vector<double> counts(8, 100.0), expected(8, 100.0);
  expected[3] = 0;
  CHECK(test::chi_square(counts, expected).p_value == 0.0);
}

TEST_CASE("Bins that expect little are pooled and no count is lost") {
  std::vector<double> expected(80, 0.125), counts(80);
  expected.push_back(90);
  counts.push_back(90);
  counts[0] = 10;
  const test::ChiSquare result = test::chi_square(counts, expected);
  CHECK(result.freedom == 2);  // two pools of 5, and the large bin
  CHECK(result.statistic == doctest::Approx(10));
}

TEST_CASE("Bins of the sphere have the same solid angle, and integrate what is known") {
  const test::SphereBins bins{.rows = 8, .columns = 16, .lowest = 0};
  CHECK(bins.solid_angle() * static_cast<double>(bins.count()) == doctest::Approx(2 * std::numbers::pi));
  const std::size_t side = 4;
  const std::vector<glm::dvec3> nodes = bins.nodes(side);
  std::vector<double> densities;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    wrong += bins.bin(nodes[i]) != i / (side * side);
    densities.push_back(nodes[i].z / std::numbers::pi);
  }
  CHECK(wrong == 0);
  double sum = 0;
  for (const double integral : bins.integrals(densities)) sum += integral;
  CHECK(sum == doctest::Approx(1.0).epsilon(1e-12));  // z is linear in the height: the midpoint rule is exact
}
