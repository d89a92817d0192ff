#include "tests/statistics/means.hpp"

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "tests/shaders/random_source.hpp"
#include "tests/statistics/chi_square.hpp"

using namespace tandem;

namespace {

std::vector<double> samples(test::RandomSource& random, std::size_t count, double low, double high) {
  std::vector<double> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(random.uniform(low, high));
  return result;
}

std::vector<pathtracer::Image> noise(std::uint32_t seed, float brighter) {
  test::RandomSource random(seed);
  std::vector<pathtracer::Image> images(6, {.width = 20, .height = 12, .pixels = {}});
  for (pathtracer::Image& image : images)
    for (std::uint32_t i = 0; i < 20 * 12; ++i) {
      const float value = static_cast<float>(random.uniform(0, 2)) + (i % 20 >= 16 ? brighter : 0.0f);
      image.pixels.emplace_back(1.0f, value, 0.0f);
    }
  return images;
}

}  // namespace

TEST_CASE("A mean has the standard error of its samples") {
  const test::Mean mean = test::mean_of(std::vector<double>{1, 2, 3, 4});
  CHECK(mean.value == 2.5);
  CHECK(mean.standard_error == doctest::Approx(std::sqrt(5.0 / 3.0 / 4.0)));
  CHECK(test::z_score(mean, 2.5) == 0.0);
  CHECK(test::z_score(mean, 2.5 - mean.standard_error) == doctest::Approx(1.0));
}

TEST_CASE("p-values of means of the same value are uniform, and small when they differ") {
  test::RandomSource random(3);
  std::vector<double> p_values(10);
  for (int i = 0; i < 2000; ++i) {
    const double p =
        test::welch_p_value(test::mean_of(samples(random, 12, 0, 1)), test::mean_of(samples(random, 30, -1, 2)));
    p_values[test::unit_interval_bin(p, p_values.size())] += 1;
  }
  CHECK(test::chi_square_uniform(p_values).p_value > 1e-3);  // the seed is fixed
  CHECK(test::welch_p_value(test::mean_of(samples(random, 1000, 0, 1)),
                            test::mean_of(samples(random, 1000, 0.1, 1.1))) < 1e-6);
  CHECK(test::welch_p_value({.value = 1, .standard_error = 0, .count = 4},
                            {.value = 1, .standard_error = 0, .count = 4}) == 1.0);
  CHECK(test::welch_p_value({.value = 1, .standard_error = 0, .count = 4},
                            {.value = 1.01, .standard_error = 0, .count = 4}) == 0.0);
}

TEST_CASE("Images of the same scene agree tile by tile, and one tile that differs is found") {
  CHECK(test::tiles_p_value(noise(4, 0), noise(5, 0), 8) > 1e-3);
  // The mean of 4 x 8 pixels of 6 images has a standard error of 0.04.
  CHECK(test::tiles_p_value(noise(4, 0), noise(5, 2.0f), 8) < 1e-6);
}
