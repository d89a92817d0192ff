// Random walks that solve integral equations. All seeds are fixed, so a test that passes goes on passing; bounds are
// those that a right program fails once in some 10^5 seeds.

#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "base/statistics/distributions.hpp"
#include "compare/study/random_walk_study.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using study::FredholmEquation;
using study::WalkEstimates;
using study::WalkEstimator;
using study::WalkSettings;

namespace {

constexpr WalkEstimator estimators[] = {WalkEstimator::fixed_length, WalkEstimator::absorption,
                                        WalkEstimator::collision, WalkEstimator::expected_value};

double position(std::size_t point, std::size_t points) {
  return (static_cast<double>(point) + 0.5) / static_cast<double>(points);
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

}  // namespace

TANDEM_DEVICE_TEST("Every estimator of every equation finds the solution at every point") {
  study::RandomWalks walks(device_handle);
  const WalkSettings settings{.points = 16};
  constexpr std::uint32_t count = 8192;
  for (const FredholmEquation& equation : study::fredholm_equations) {
    for (const WalkEstimator estimator : estimators) {
      CAPTURE(std::string(equation.name));
      CAPTURE(study::walk_estimator_names()[static_cast<std::size_t>(estimator)]);
      const WalkEstimates estimates = walks.run(equation.kernel, estimator, settings, 0, count);
      // Sums of 8192 scores are normal enough. The points' walks are independent: the sum of the squared deviations is
      // chi-square. The fixed length leaves out 2^-24 of the series, 10^-4 of a standard error.
      double chi_square = 0;
      for (std::size_t i = 0; i < settings.points; ++i) {
        const double error = estimates.means[i] - study::fredholm_solution(position(i, settings.points));
        chi_square += error * error / (estimates.variances[i] / count);
      }
      CHECK(statistics::chi_square_p_value(chi_square, settings.points) > 1e-5);
    }
  }
}

TANDEM_DEVICE_TEST("A walk that is too short leaves out what the Neumann series says") {
  // After the terms 0 and 1 of the product kernel, whose K^m f = x (2/3) / 3^(m-1): sum of m >= 2 is x / 3.
  study::RandomWalks walks(device_handle);
  const WalkSettings settings{.points = 4, .length = 1};
  constexpr std::uint32_t count = 16384;
  const WalkEstimates estimates =
      walks.run(study::FredholmKernel::product, WalkEstimator::fixed_length, settings, 0, count);
  for (std::size_t i = 0; i < settings.points; ++i) {
    const double x = position(i, settings.points);
    const double z = (estimates.means[i] - (std::exp(x) - x / 3)) / std::sqrt(estimates.variances[i] / count);
    CHECK(std::abs(z) < 5);
  }
}

TANDEM_DEVICE_TEST("The variance of a walk is that which follows from the equation") {
  // The second moment of the absorption estimator solves an equation of its own, v(x) = f(x)^2 / p + the integral of
  // k(x, t)^2 / (1 - p) v(t). With the product kernel, v(x) = f(x)^2 / p + x^2 A / (1 - p), where A, the integral of
  // t^2 v(t), is that of t^2 f(t)^2 / p over 1 - 1 / (5 (1 - p)).
  const WalkSettings settings{.points = 16};
  const double p = settings.absorption;
  const auto source = [](double t) { return std::exp(t) - t; };
  double integral = 0;
  constexpr std::size_t cells = 10000;
  for (std::size_t i = 0; i < cells; ++i) {
    const double t = position(i, cells);
    integral += t * t * source(t) * source(t) / p / cells;
  }
  const double a = integral / (1 - 0.2 / (1 - p));
  std::vector<double> expected;
  for (std::size_t i = 0; i < settings.points; ++i) {
    const double x = position(i, settings.points);
    expected.push_back(source(x) * source(x) / p + x * x * a / (1 - p) - std::exp(2 * x));
  }
  study::RandomWalks walks(device_handle);
  const WalkEstimates estimates =
      walks.run(study::FredholmKernel::product, WalkEstimator::absorption, settings, 0, 16384);
  // Scores have a kurtosis below 40, so the mean of 16 variances is known within (40 / (16 * 16384))^1/2 = 0.012.
  CHECK(mean(estimates.variances) == doctest::Approx(mean(expected)).epsilon(0.05));
}

TANDEM_DEVICE_TEST("Expectations in place of scores lower the variance of walks") {
  study::RandomWalks walks(device_handle);
  const WalkSettings settings{.points = 16};
  for (const FredholmEquation& equation : study::fredholm_equations) {
    CAPTURE(std::string(equation.name));
    const auto variance = [&](WalkEstimator estimator) {
      return mean(walks.run(equation.kernel, estimator, settings, 0, 4096).variances);
    };
    // By a third at least; 16 times 4096 walks know each within a few hundredths.
    CHECK(variance(WalkEstimator::expected_value) < 0.8 * variance(WalkEstimator::collision));
  }
}

TANDEM_DEVICE_TEST("The error of random walks falls as N^-1/2") {
  const study::RandomWalkSettings settings{.walks = {.points = 64}, .walk_counts = {64, 512, 4096}};
  const auto results = study::study_random_walks(device_handle, settings);
  REQUIRE(results.has_value());
  REQUIRE(results->size() == study::fredholm_equations.size());
  for (const study::FredholmResult& result : *results) {
    for (const study::WalkEstimatorResult& estimator : result.estimators) {
      // An RMSE over 64 points has a relative error of 1 / sqrt(128) = 0.09, so a slope over a factor of 64 one of
      // sqrt(2) * 0.09 / ln 64 = 0.03.
      CHECK(std::abs(estimator.slope() + 0.5) < 4.5 * 0.03);
      for (const study::WalkMeasurement& measurement : estimator.measurements)
        CHECK(measurement.rmse == doctest::Approx(measurement.expected).epsilon(4.5 * 0.09));
    }
  }
}

TEST_CASE("Random walks give the same bits on every device, and other bits under another seed") {
  const test::NoWarnings no_warnings;
  WalkSettings settings{.points = 8};
  const auto run = [&](const std::string& name) {
    study::RandomWalks walks(test::device(name));
    std::vector<double> bits;
    for (const FredholmEquation& equation : study::fredholm_equations) {
      for (const WalkEstimator estimator : estimators) {
        const WalkEstimates estimates = walks.run(equation.kernel, estimator, settings, 64, 128);
        bits.insert(bits.end(), estimates.means.begin(), estimates.means.end());
        bits.insert(bits.end(), estimates.variances.begin(), estimates.variances.end());
      }
    }
    return bits;
  };
  const std::vector<double> expected = run("cpu");
  for (const std::string& name : test::device_names()) {
    CAPTURE(name);
    CHECK(run(name) == expected);
  }
  settings.seed = 2;
  CHECK(run("cpu") != expected);
}
