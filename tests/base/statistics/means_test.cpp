#include "base/statistics/means.hpp"

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "tests/shaders/random_source.hpp"
#include "tests/support/statistics/chi_square.hpp"

using namespace tandem;

namespace {

std::vector<double> samples(test::RandomSource& random, std::size_t count, double low, double high) {
  std::vector<double> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(random.uniform(low, high));
  return result;
}

}  // namespace

TEST_CASE("A mean has the standard error of its samples") {
  const statistics::Mean mean = statistics::mean_of(std::vector<double>{1, 2, 3, 4});
  CHECK(mean.value == 2.5);
  CHECK(mean.standard_error == doctest::Approx(std::sqrt(5.0 / 3.0 / 4.0)));
  CHECK(statistics::z_score(mean, 2.5) == 0.0);
  CHECK(statistics::z_score(mean, 2.5 - mean.standard_error) == doctest::Approx(1.0));
}

TEST_CASE("p-values of means of the same value are uniform, and small when they differ") {
  test::RandomSource random(3);
  std::vector<double> p_values(10);
  for (int i = 0; i < 2000; ++i) {
    const double p = statistics::welch_p_value(statistics::mean_of(samples(random, 12, 0, 1)),
                                               statistics::mean_of(samples(random, 30, -1, 2)));
    p_values[test::unit_interval_bin(p, p_values.size())] += 1;
  }
  CHECK(test::chi_square_uniform(p_values).p_value > 1e-3);  // the seed is fixed
  CHECK(statistics::welch_p_value(statistics::mean_of(samples(random, 1000, 0, 1)),
                                  statistics::mean_of(samples(random, 1000, 0.1, 1.1))) < 1e-6);
  CHECK(statistics::welch_p_value({.value = 1, .standard_error = 0, .count = 4},
                                  {.value = 1, .standard_error = 0, .count = 4}) == 1.0);
  CHECK(statistics::welch_p_value({.value = 1, .standard_error = 0, .count = 4},
                                  {.value = 1.01, .standard_error = 0, .count = 4}) == 0.0);
}
