// What each sampler promises of many pixels: uniformity, independence, and how fast its error falls.

#include <cmath>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "base/statistics/means.hpp"
#include "compare/study/convergence.hpp"
#include "tests/shaders/sampling/sampler_draws.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/statistics/chi_square.hpp"

using namespace tandem;
using test::Bits;
using test::Draw;
using test::fraction;

namespace {

/// Pearson's, of number `i` of the samples [first, first + count) of a and number `j` of those of b.
double correlation(const std::vector<Bits>& a, std::size_t i, const std::vector<Bits>& b, std::size_t j,
                   std::size_t first, std::size_t count) {
  double sum_a = 0, sum_b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t k = first; k < first + count; ++k) {
    const double x = fraction(a[k][i]) - 0.5, y = fraction(b[k][j]) - 0.5;
    sum_a += x;
    sum_b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  const double n = static_cast<double>(count);
  return (ab - sum_a * sum_b / n) / std::sqrt((aa - sum_a * sum_a / n) * (bb - sum_b * sum_b / n));
}

/// Smooth, with the integral 1 over the unit cube; of the first `count` numbers.
double smooth(const Bits& point, std::size_t count) {
  double product = 1;
  for (std::size_t i = 0; i < count; ++i) product *= 1.0 + 0.5 * (std::exp(fraction(point[i])) - std::numbers::e + 1.0);
  return product;
}

std::vector<Draw> draws_of_pixels(std::uint32_t side, std::uint32_t samples, std::uint32_t dimension,
                                  std::uint32_t seed = 1) {
  std::vector<Draw> draws;
  for (std::uint32_t pixel = 0; pixel < side * side; ++pixel)
    for (std::uint32_t sample = 0; sample < samples; ++sample)
      draws.push_back({.x = pixel % side, .y = pixel / side, .sample = sample, .dimension = dimension, .seed = seed});
  return draws;
}

/// The error of the mean over the samples of each pixel, of `smooth` of so many numbers.
std::vector<double> errors(rhi::Device& device, const test::Sampler& sampler, std::uint32_t side, std::uint32_t samples,
                           std::size_t numbers = 4, std::uint32_t seed = 1) {
  const std::vector<Bits> points = test::draw(device, sampler, samples, draws_of_pixels(side, samples, 2, seed));
  std::vector<double> result(std::size_t{side} * side);
  for (std::size_t i = 0; i < points.size(); ++i) result[i / samples] += smooth(points[i], numbers) / samples;
  for (double& value : result) value -= 1.0;
  return result;
}

double mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

// Numbers are fixed, so that a passing test cannot fail later; of some hundred p-values the smallest is expected near
// 1e-2.
constexpr double least_p_value = 1e-4;

}  // namespace

TANDEM_DEVICE_TEST("Every sample of every sampler is uniform, alone and in pairs, over pixels and over seeds") {
  constexpr std::uint32_t count = 1 << 14;
  for (const test::Sampler& sampler : test::samplers)
    for (const bool over_pixels : {true, false})
      for (const std::uint32_t dimension : {0u, 3u, 9u}) {
        std::vector<Draw> draws;
        for (std::uint32_t i = 0; i < count; ++i)
          draws.push_back({.x = over_pixels ? i % 128 : 3,
                           .y = over_pixels ? i / 128 : 4,
                           .sample = 5,
                           .dimension = dimension,
                           .seed = over_pixels ? 0 : i});
        const std::vector<Bits> points = test::draw(device, sampler, 16, draws);
        for (std::size_t i = 0; i < 4; ++i) {
          std::vector<double> alone(64), pairs(256);
          for (const Bits& point : points) {
            alone[point[i] >> 26] += 1;
            pairs[(point[i] >> 28) << 4 | point[(i + 1) % 4] >> 28] += 1;
          }
          INFO(sampler.name, ", dimension ", dimension, ", number ", i, ", over pixels: ", over_pixels);
          CHECK(test::chi_square_uniform(alone).p_value > least_p_value);
          CHECK(test::chi_square_uniform(pairs).p_value > least_p_value);
        }
      }
}

TANDEM_DEVICE_TEST("Dimensions of a path are uncorrelated within the samples of each pixel") {
  constexpr std::uint32_t side = 16, samples = 64;
  for (const test::Sampler& sampler : test::samplers) {
    std::vector<std::vector<Bits>> points;
    for (const std::uint32_t dimension : {0u, 1u, 2u, 6u, 7u, 10u})
      points.push_back(test::draw(device, sampler, samples, draws_of_pixels(side, samples, dimension)));
    for (std::size_t a = 0; a < points.size(); ++a)
      for (std::size_t b = a + 1; b < points.size(); ++b)
        for (std::size_t i = 0; i < 4; ++i) {
          std::vector<double> squares;
          for (std::size_t pixel = 0; pixel < side * side; ++pixel)
            squares.push_back((samples - 1) *
                              std::pow(correlation(points[a], i, points[b], (i + a) % 4, pixel * samples, samples), 2));
          // Of random orders the expectation is 1 and the variance of a square is 2, so the standard error of the mean
          // is sqrt(2 / 256) = 0.09. Orders that keep blocks of powers of two together, as those of Sobol do, decide
          // the leading bit of half of the samples only: up to 2. The same sequence twice has some 30.
          const statistics::Mean mean = statistics::mean_of(squares);
          INFO(sampler.name, ", dimensions number ", a, " and ", b, ", number ", i);
          CHECK(mean.value < (sampler.call.starts_with("sobol") ? 2.6 : 1.4));
        }
  }
}

TANDEM_DEVICE_TEST("Neighbouring pixels are uncorrelated, but of blue noise") {
  constexpr std::uint32_t side = 64;
  for (const test::Sampler& sampler :
       {test::independent, test::stratified, test::halton, test::hammersley, test::sobol}) {
    std::vector<Draw> draws, right, below;
    for (const Draw& draw : draws_of_pixels(side, 4, 1)) {
      draws.push_back(draw);
      right.push_back(draw);
      right.back().x += 1;
      below.push_back(draw);
      below.back().y += 1;
    }
    const std::vector<Bits> here = test::draw(device, sampler, 4, draws);
    for (const std::vector<Draw>& neighbours : {right, below}) {
      const std::vector<Bits> there = test::draw(device, sampler, 4, neighbours);
      for (std::size_t i = 0; i < 4; ++i) {
        INFO(sampler.name, ", number ", i);
        // Standard deviation 1 / sqrt(16384) = 0.0078, or less: the four samples of a pixel are spread out.
        CHECK(std::abs(correlation(here, i, there, i, 0, here.size())) < 4.5 * 0.0078);
      }
    }
  }
}

TANDEM_DEVICE_TEST("The error of a smooth integrand falls as N^-1/2 with independent samples, faster with all others") {
  const std::vector<double> counts = {4, 16, 64, 256};
  struct Order {
    test::Sampler sampler;
    std::size_t numbers;  ///< that the integrand depends on
    double least, most;   ///< of the slope
  };
  // Of four numbers stratification leaves what depends on both pairs, which falls as N^-1/2, behind what falls as N^-1.
  // Scrambled nets have N^-3/2 at best.
  for (const Order& order : {Order{test::independent, 2, -0.55, -0.45},
                             {test::stratified, 2, -1.2, -0.85},
                             {test::halton, 2, -1.4, -0.85},
                             {test::hammersley, 2, -1.6, -0.85},
                             {test::sobol, 2, -1.6, -1.2},
                             {test::blue_noise, 2, -1.6, -1.2},
                             {test::independent, 4, -0.55, -0.45},
                             {test::stratified, 4, -0.8, -0.55},
                             {test::halton, 4, -1.4, -0.75},
                             {test::hammersley, 4, -1.4, -0.75},
                             {test::sobol, 4, -1.6, -0.85},
                             {test::blue_noise, 4, -1.6, -0.85}}) {
    std::vector<double> rmse;
    for (const double count : counts)
      rmse.push_back(
          std::sqrt(mean_square(errors(device, order.sampler, 16, static_cast<std::uint32_t>(count), order.numbers))));
    const study::Line line = study::convergence(counts, rmse);
    INFO(order.sampler.name, ", ", order.numbers, " numbers: slope ", line.slope, ", error with 256 samples ",
         rmse.back());
    CHECK(line.slope > order.least);
    CHECK(line.slope < order.most);
  }
}

TANDEM_DEVICE_TEST("Blue noise has little error left where neighbouring pixels are averaged") {
  constexpr std::uint32_t side = 64, samples = 4, seeds = 8;
  const auto averaged = [&](const test::Sampler& sampler, std::uint32_t block) {
    const std::uint32_t blocks = side / block;
    double sum = 0;
    for (std::uint32_t seed = 0; seed < seeds; ++seed) {
      const std::vector<double> fine = errors(device, sampler, side, samples, 4, seed);
      std::vector<double> coarse(std::size_t{blocks} * blocks);
      for (std::uint32_t i = 0; i < side * side; ++i)
        coarse[i / side / block * blocks + i % side / block] += fine[i] / (block * block);
      sum += mean_square(coarse) / seeds;
    }
    return sum;
  };
  const double white = averaged(test::sobol, 1);
  // The same in single pixels, but that all pixels of a tile share their scrambling, so that eight seeds are eight
  // samples of it.
  CHECK(averaged(test::blue_noise, 1) < 1.3 * white);
  // White noise: the mean over 16 pixels has a sixteenth of the variance.
  CHECK(averaged(test::sobol, 4) > 0.8 * white / 16);
  CHECK(averaged(test::blue_noise, 4) < 0.25 * white / 16);
  CHECK(averaged(test::blue_noise, 8) < 0.1 * white / 64);
}
