// The Monte Carlo estimators that lectures teach with the integral of sqrt(x) sin(x) over [0, pi], and the ways to make
// random numbers of a given density. The arithmetic is that of the shaders, on the device.

#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "base/statistics/means.hpp"
#include "compare/study/convergence.hpp"
#include "tests/shaders/function_kernel.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/statistics/chi_square.hpp"

using namespace tandem;

namespace {

constexpr double published = 2.435321164;
constexpr double pi = std::numbers::pi;

double integrand(double x) { return std::sqrt(x) * std::sin(x); }

/// The integral over [0, pi] by the midpoint rule, to some 1e-9 of functions with one square root.
double integral(const std::function<double(double)>& function) {
  constexpr int steps = 1'000'000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += function(pi * (i + 0.5) / steps);
  return sum * pi / steps;
}

/// A way to estimate: `x` from `u` in [0, 1), and the density of x.
struct Estimator {
  const char* name;
  const char* x;        ///< GLSL
  const char* density;  ///< GLSL
  std::function<double(double)> exact_density;
};

const Estimator mean_method{"mean", "PI * u", "INV_PI", [](double) { return 1 / pi; }};
const Estimator sine{"importance of sine", "det_acos(1.0 - 2.0 * u)", "0.5 * det_sin(x)",
                     [](double x) { return 0.5 * std::sin(x); }};
const Estimator root{"importance of the root", "PI * det_pow(u, 0.666666687)", "0.269400179 * det_sqrt(x)",
                     [](double x) { return 1.5 / std::pow(pi, 1.5) * std::sqrt(x); }};

/// `repetitions` estimates of `count` samples each. @param draw GLSL for uvec4 bits of `key`, for `count` samples
std::vector<double> estimates(rhi::Device& device, const Estimator& estimator, const std::string& draw,
                              std::uint32_t count, std::uint32_t repetitions) {
  const test::FunctionKernel kernel = {.includes =
                                           "#include \"sampling/halton.glsl\"\n"
                                           "#include \"sampling/stratified.glsl\"\n"
                                           "precise float location(float u) { return " +
                                           std::string(estimator.x) +
                                           "; }\n"
                                           "precise float density(float x) { return " +
                                           estimator.density + "; }",
                                       .body = R"(
    RandomKey key;
    key.pixel = input_bits(0);
    key.sample_index = input_bits(1);
    key.seed = 3;
    uint count = input_bits(2);
    float x = location(unit_interval()" + draw +
                                               R"(.x));
    float p = density(x);
    // An end of the interval has the density 0, and a value of 0 too.
    output_float(0, p > 0.0 ? det_div(det_sqrt(x) * det_sin(x), p) : 0.0);)",
                                       .input_count = 3};
  std::vector<std::uint32_t> inputs;
  for (std::uint32_t repetition = 0; repetition < repetitions; ++repetition)
    for (std::uint32_t i = 0; i < count; ++i) inputs.insert(inputs.end(), {repetition, i, count});
  const std::vector<std::uint32_t> bits = test::run_bits(device, kernel, inputs);
  std::vector<double> result(repetitions);
  for (std::size_t i = 0; i < bits.size(); ++i) result[i / count] += double{std::bit_cast<float>(bits[i])} / count;
  return result;
}

const std::string independent = "random_bits(key, 0)";
const std::string stratified = "stratified_bits(key, 0, count)";
const std::string halton = "halton_bits(key, 0, count, false)";

double rms_error(const std::vector<double>& estimates) {
  double sum = 0;
  for (const double estimate : estimates) sum += (estimate - published) * (estimate - published);
  return std::sqrt(sum / static_cast<double>(estimates.size()));
}

/// A chi-square test of `count` numbers that GLSL makes of bits over 32 equal bins of [low, high].
double p_value_of(rhi::Device& device, const std::string& number, double low, double high,
                  const std::function<double(double)>& cumulative) {
  constexpr std::uint32_t count = 1 << 17, bins = 32;
  std::vector<std::uint32_t> inputs(count);
  for (std::uint32_t i = 0; i < count; ++i) inputs[i] = i;
  const std::vector<std::uint32_t> outputs = test::run_bits(device,
                                                            {.includes = R"(#include "math.glsl"
#include "random.glsl"
RandomKey key_of(uint pixel) {
  RandomKey key;
  key.pixel = pixel;
  key.sample_index = 0;
  key.seed = 5;
  return key;
}
// x in [0, pi] with the density sin(x) / 2: uniform points under the arc of the sine, by their x.
precise float rejected_sine(RandomKey key) {
  float x = 0.0;
  for (uint attempt = 0; attempt < 100; ++attempt) {
    uvec4 bits = random_bits(key, attempt);
    x = PI * unit_interval(bits.x);
    if (unit_interval(bits.y) < det_sin(x)) break;
  }
  return x;
})",
                                                             .body = R"(
    float u = unit_interval(random_bits(key_of(input_bits(0)), 0).x);
    output_float(0, )" + number + ");"},
                                                            inputs);
  std::vector<double> counts(bins), expected(bins);
  std::size_t outside = 0;
  for (const std::uint32_t output : outputs) {
    const double value = double{std::bit_cast<float>(output)};
    outside += value >= low - 1e-6 && value <= high + 1e-6 ? 0 : 1;
    counts[test::unit_interval_bin((value - low) / (high - low), bins)] += 1;
  }
  REQUIRE(outside == 0);
  const auto edge = [&](std::uint32_t i) { return low + (high - low) * i / bins; };
  for (std::uint32_t i = 0; i < bins; ++i) expected[i] = cumulative(edge(i + 1)) - cumulative(edge(i));
  return test::chi_square(counts, expected).p_value;
}

}  // namespace

TEST_CASE("The integral that the lecture gives is right") {
  CHECK(integral(integrand) == doctest::Approx(published).epsilon(1e-9));
}

TANDEM_DEVICE_TEST("Estimators of the lecture are unbiased and have the variance of theory; importance lowers it") {
  std::vector<double> variances;
  for (const Estimator& estimator : {mean_method, root, sine}) {
    constexpr std::uint32_t count = 1000, repetitions = 1000;  // as in the lecture, of its ten thousand estimates
    const std::vector<double> values = estimates(device, estimator, independent, count, repetitions);
    const statistics::Mean mean = statistics::mean_of(values);
    const double second_moment =
        integral([&](double x) { return integrand(x) * integrand(x) / estimator.exact_density(x); });
    const double theory = (second_moment - published * published) / count;
    const double variance = mean.standard_error * mean.standard_error * repetitions;
    INFO(estimator.name, ": ", mean.value, " +- ", mean.standard_error);
    CHECK(std::abs(statistics::z_score(mean, published)) < 4);
    // The standard deviation of a sample variance is sqrt(2 / 999) of it.
    CHECK(variance == doctest::Approx(theory).epsilon(4 * 0.045));
    variances.push_back(variance);
  }
  // With N samples each, the efficiency 1 / (V T) grows as the variance falls: theory has 1.82, 1.27 and 0.352.
  CHECK(variances[0] > 1.2 * variances[1]);
  CHECK(variances[1] > 2.5 * variances[2]);
}

TANDEM_DEVICE_TEST("The error of estimates falls as N^-1/2; stratified and with Halton's sequence faster") {
  const std::vector<double> counts = {16, 64, 256, 1024};
  struct Order {
    std::string draw;
    double least, most;
  };
  // One jittered sample in each of N strata has N^-3/2; a scrambled sequence has that too at the powers of its base.
  for (const Order& order : {Order{independent, -0.6, -0.4}, {stratified, -1.6, -1.4}, {halton, -1.6, -1.4}}) {
    std::vector<double> errors;
    for (const double count : counts)
      errors.push_back(rms_error(estimates(device, mean_method, order.draw, static_cast<std::uint32_t>(count), 200)));
    const study::Line line = study::convergence(counts, errors);
    INFO(order.draw, ": slope ", line.slope);
    CHECK(line.slope > order.least);
    CHECK(line.slope < order.most);
  }
}

TANDEM_DEVICE_TEST("Transformed random numbers have the densities that the lecture derives") {
  CHECK(p_value_of(device, "u + 1.0", 1, 2, [](double y) { return y - 1; }) > 1e-3);
  CHECK(p_value_of(device, "2.0 * u", 0, 2, [](double y) { return y / 2; }) > 1e-3);
  CHECK(p_value_of(device, "u * u", 0, 1, [](double y) { return std::sqrt(y); }) > 1e-3);
  CHECK(p_value_of(device, "det_exp(u - 1.0)", std::exp(-1), 1, [](double y) { return 1 + std::log(y); }) > 1e-3);
}

TANDEM_DEVICE_TEST("Inverse transform and rejection give the same density") {
  const auto cumulative = [](double x) { return 0.5 * (1 - std::cos(x)); };
  CHECK(p_value_of(device, "det_acos(1.0 - 2.0 * u)", 0, pi, cumulative) > 1e-3);
  CHECK(p_value_of(device, "rejected_sine(key_of(input_bits(0)))", 0, pi, cumulative) > 1e-3);
  CHECK(p_value_of(device, "PI * det_pow(u, 0.666666687)", 0, pi, [](double x) { return std::pow(x / pi, 1.5); }) >
        1e-3);
  // The test has the power to tell them from a density that is close by.
  CHECK(p_value_of(device, "det_acos(1.0 - 2.0 * u)", 0, pi,
                   [](double x) { return 0.5 * (1 - std::cos(x)) + 0.005 * std::sin(2 * x); }) < 1e-6);
}
