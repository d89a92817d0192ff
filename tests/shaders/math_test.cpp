#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/shaders/function_kernel.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

constexpr float smallest_normal = std::numeric_limits<float>::min();
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

test::FunctionKernel math_kernel(const std::string& expression, std::uint32_t input_count) {
  return {
      .includes = "#include \"math.glsl\"", .body = "output_float(0, " + expression + ");", .input_count = input_count};
}

test::FunctionKernel unary(const std::string& function) { return math_kernel(function + "(input_float(0))", 1); }

/// Floats of all magnitudes in [low, high], spread over their bit patterns; no subnormal numbers, which a device may
/// flush to zero.
std::vector<float> floats_between(float low, float high, std::size_t count) {
  test::RandomSource random(17);
  std::vector<float> values = {low, high, 0.0f, -0.0f, 1.0f, -1.0f, 0.5f, -0.5f, smallest_normal, -smallest_normal};
  while (values.size() < count / 2) values.push_back(static_cast<float>(random.uniform(low, high)));
  while (values.size() < count) values.push_back(std::bit_cast<float>(random.bits()));
  std::erase_if(values,
                [&](float x) { return !(x >= low && x <= high) || (x != 0.0f && std::abs(x) < smallest_normal); });
  return values;
}

struct Function {
  std::string name;
  std::function<double(double)> exact;
  float low;
  float high;
  double ulp;  ///< the bound that the function's docstring states
};

const std::vector<Function> functions = {
    {"det_sin", [](double x) { return std::sin(x); }, -8192.0f, 8192.0f, 2.5},
    {"det_cos", [](double x) { return std::cos(x); }, -8192.0f, 8192.0f, 2.5},
    {"sin_kernel", [](double x) { return std::sin(x); }, -0.785398185f, 0.785398185f, 1.0},
    {"cos_kernel", [](double x) { return std::cos(x); }, -0.785398185f, 0.785398185f, 1.0},
    {"det_exp", [](double x) { return std::exp(x); }, -87.336f, 88.72283f, 1.5},
    {"det_log", [](double x) { return std::log(x); }, smallest_normal, 3.4e38f, 1.0},
    {"asin_kernel", [](double x) { return std::asin(x); }, -0.5f, 0.5f, 1.0},
    {"det_acos", [](double x) { return std::acos(x); }, -1.0f, 1.0f, 1.5},
    {"det_atan", [](double x) { return std::atan(x); }, -3.4e38f, 3.4e38f, 2.5},
};

/// Arguments at which something is likely to break.
const std::vector<float> hostile = {0.0f,   -0.0f,    1.0f,         -1.0f,        smallest_normal, -smallest_normal,
                                    1e-44f, -1e-44f,  3.4e38f,      -3.4e38f,     infinity,        -infinity,
                                    8192.f, 8193.0f,  not_a_number, 88.72283f,    88.8f,           -87.33654f,
                                    -88.0f, 1e-20f,   1e20f,        0.999999940f, 1.00000012f,     2.41421366f,
                                    1e10f,  -8192.1f, 0.41421357f,  1.57079637f,  3.14159274f,     0.707106769f};

}  // namespace

TANDEM_DEVICE_TEST("Mathematical functions are as exact as their docstrings say") {
  for (const Function& function : functions) {
    const std::vector<float> inputs = floats_between(function.low, function.high, 1 << 20);
    REQUIRE(inputs.size() > 100000);
    const std::vector<float> outputs = test::run(device, unary(function.name), inputs);
    double worst = 0.0;
    float worst_input = 0.0f;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const double exact = function.exact(inputs[i]);
      // A result below the normal numbers may be 0.
      if (std::abs(exact) < smallest_normal && outputs[i] == 0.0f) continue;
      const double error = test::ulp_distance(exact, outputs[i]);
      if (!(error <= worst)) {
        worst = error;
        worst_input = inputs[i];
      }
    }
    INFO(function.name, " is worst at ", worst_input);
    CHECK(worst <= function.ulp);
  }
}

TANDEM_DEVICE_TEST("det_pow is as exact as its docstring says") {
  test::RandomSource random(3);
  const auto uniform = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
  std::vector<float> inputs;
  for (int i = 0; i < 1 << 18; ++i) {
    inputs.insert(inputs.end(), {std::exp2(uniform(-126, 127.99)), uniform(-4, 4)});
    inputs.insert(inputs.end(), {uniform(0, 4), uniform(-60, 60)});
    inputs.insert(inputs.end(), {1 + uniform(-1e-3, 1e-3), uniform(-80000, 80000)});
    inputs.insert(inputs.end(), {uniform(0, 1), 1 / 2.4f});
  }
  const std::vector<float> outputs =
      test::run(device, math_kernel("det_pow(input_float(0), input_float(1))", 2), inputs);
  double worst = 0.0;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const double exact = std::pow(double{inputs[2 * i]}, double{inputs[2 * i + 1]});
    if (exact < smallest_normal) {
      CHECK(outputs[i] <= smallest_normal);
    } else if (exact > 3.4e38) {
      CHECK(outputs[i] >= 3.39e38f);
    } else {
      worst = std::max(worst, test::ulp_distance(exact, outputs[i]));
    }
  }
  CHECK(worst <= 2.0);
}

TANDEM_DEVICE_TEST("det_atan2 is as exact as its docstring says") {
  test::RandomSource random(19);
  std::vector<float> inputs;
  const auto add = [&](double magnitude) {
    inputs.push_back(static_cast<float>(random.uniform(-magnitude, magnitude)));
    inputs.push_back(static_cast<float>(random.uniform(-magnitude, magnitude)));
  };
  for (int i = 0; i < 1 << 18; ++i) {
    add(1);
    add(std::exp2(random.uniform(-100, 126)));
    inputs.insert(inputs.end(),
                  {std::exp2(static_cast<float>(random.uniform(-60, 60))), random.bits() % 2 ? 1.f : -1.f});
    inputs.insert(inputs.end(),
                  {random.bits() % 2 ? 3.f : -3.f, std::exp2(static_cast<float>(random.uniform(-60, 60)))});
  }
  const std::vector<float> outputs =
      test::run(device, math_kernel("det_atan2(input_float(0), input_float(1))", 2), inputs);
  double worst = 0.0;
  for (std::size_t i = 0; i < outputs.size(); ++i)
    worst =
        std::max(worst, test::ulp_distance(std::atan2(double{inputs[2 * i]}, double{inputs[2 * i + 1]}), outputs[i]));
  CAPTURE(worst);
  CHECK(worst <= 3.0);

  const std::vector<float> axes = test::run(device, math_kernel("det_atan2(input_float(0), input_float(1))", 2),
                                            {0, 1, 0, -1, 1, 0, -1, 0, 0, 0, 1, 1, -1, -1});
  const float pi = 3.14159274f;
  CHECK(axes == std::vector<float>{0, pi, 0.5f * pi, -0.5f * pi, 0, 0.25f * pi, -0.75f * pi});
}

TANDEM_DEVICE_TEST("Mathematical functions give finite results for every argument") {
  for (const std::string function : {"det_sin", "det_cos", "det_exp", "det_log", "det_acos", "det_atan"}) {
    const std::vector<float> outputs = test::run(device, unary(function), hostile);
    for (std::size_t i = 0; i < hostile.size(); ++i) {
      INFO(function, " of ", hostile[i], " is ", outputs[i]);
      CHECK(std::isfinite(outputs[i]));
    }
  }
  std::vector<float> pairs;
  for (const float x : hostile)
    for (const float y : hostile) pairs.insert(pairs.end(), {x, y});
  const std::vector<float> powers = test::run(device, math_kernel("det_pow(input_float(0), input_float(1))", 2), pairs);
  for (std::size_t i = 0; i < powers.size(); ++i) {
    INFO(pairs[2 * i], " to the power of ", pairs[2 * i + 1], " is ", powers[i]);
    CHECK(std::isfinite(powers[i]));
  }
  for (const float angle : test::run(device, math_kernel("det_atan2(input_float(0), input_float(1))", 2), pairs))
    CHECK(std::isfinite(angle));
}

TANDEM_DEVICE_TEST("Exact values of the mathematical functions") {
  const auto value = [&](const std::string& expression) {
    return test::run(device, math_kernel(expression, 1), {0.0f}).front();
  };
  CHECK(value("det_sin(input_float(0))") == 0.0f);
  CHECK(value("det_cos(input_float(0))") == 1.0f);
  CHECK(value("det_exp(input_float(0))") == 1.0f);
  CHECK(value("det_log(1.0 + input_float(0))") == 0.0f);
  CHECK(value("det_acos(1.0 + input_float(0))") == 0.0f);
  CHECK(value("det_atan(input_float(0))") == 0.0f);
  CHECK(value("det_pow(2.0 + input_float(0), 10.0)") == 1024.0f);
  CHECK(value("det_pow(input_float(0), 0.0)") == 1.0f);
  CHECK(value("det_pow(input_float(0), 2.0)") == 0.0f);
}

TEST_CASE("Every device computes the same bits") {
  const test::NoWarnings no_warnings;
  test::RandomSource random(5);
  std::vector<float> all_magnitudes;
  while (all_magnitudes.size() < 2000000) {
    const float value = std::bit_cast<float>(random.bits());
    if (std::isfinite(value) && std::abs(value) >= smallest_normal) all_magnitudes.push_back(value);
  }
  // Components of vectors: no quotient of two is subnormal, which a device may flush.
  std::vector<float> moderate;
  for (int i = 0; i < 2000000; ++i) moderate.push_back(static_cast<float>(random.uniform(-1000, 1000)));

  const auto check = [](const test::FunctionKernel& kernel, const std::vector<float>& inputs) {
    const std::vector<std::string>& names = test::device_names();
    const std::vector<float> expected = test::run(*test::device(names.front()), kernel, inputs);
    for (std::size_t other = 1; other < names.size(); ++other) {
      const std::vector<float> actual = test::run(*test::device(names[other]), kernel, inputs);
      std::size_t different = 0;
      for (std::size_t i = 0; i < expected.size(); ++i)
        different += std::bit_cast<std::uint32_t>(expected[i]) != std::bit_cast<std::uint32_t>(actual[i]);
      INFO(kernel.body, " on ", names.front(), " and ", names[other]);
      CHECK(different == 0);
    }
  };
  for (const Function& function : functions) {
    if (function.name.ends_with("_kernel")) continue;
    check(unary(function.name), all_magnitudes);
  }
  check(math_kernel("det_pow(abs(input_float(0)), input_float(1))", 2), all_magnitudes);
  check(math_kernel("det_atan2(input_float(0), input_float(1))", 2), all_magnitudes);
  for (const char* kernel : {"sin_kernel", "cos_kernel", "asin_kernel"})
    check(math_kernel(kernel + std::string("(0.0005 * input_float(0))"), 1), moderate);
  check({.includes = "#include \"math.glsl\"",
         .body = R"(
    precise vec3 v = vec3(input_float(0), input_float(1), 1.0);
    precise vec3 n = det_normalize(v, vec3(0.0));
    precise vec3 c = det_cross(n, vec3(0.36, 0.48, 0.8));
    precise vec3 r = det_reflect(c, n);
    output_float(0, r.x); output_float(1, r.y); output_float(2, r.z); output_float(3, det_length(c));)",
         .input_count = 2,
         .output_count = 4},
        moderate);
}

TANDEM_DEVICE_TEST("TANDEM_EXACT_DIVISION gives the correctly rounded quotient and root") {
  test::RandomSource random(7);
  std::vector<float> inputs;
  for (int i = 0; i < 1 << 19; ++i) {
    const auto magnitude = [&] { return std::exp2(static_cast<float>(random.uniform(-40, 40))); };
    inputs.insert(inputs.end(), {magnitude(), random.bits() % 2 == 0 ? magnitude() : -magnitude()});
  }
  test::FunctionKernel kernel = {.includes = "#define TANDEM_EXACT_DIVISION\n#include \"math.glsl\"",
                                 .body = R"(
    output_float(0, det_div(input_float(0), input_float(1)));
    output_float(1, det_sqrt(input_float(0)));)",
                                 .input_count = 2,
                                 .output_count = 2};
  const std::vector<float> outputs = test::run(device, kernel, inputs);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < inputs.size(); i += 2) {
    wrong += outputs[i] != inputs[i] / inputs[i + 1];
    wrong += outputs[i + 1] != std::sqrt(inputs[i]);
  }
  CHECK(wrong == 0);
}

TANDEM_DEVICE_TEST("det_normalize gives unit vectors at all scales and its fallback where there is no direction") {
  test::RandomSource random(11);
  std::vector<float> inputs;
  for (int i = 0; i < 100000; ++i) {
    const double scale = std::exp2(random.uniform(-110, 110));
    for (int k = 0; k < 3; ++k) inputs.push_back(static_cast<float>(random.uniform(-scale, scale)));
  }
  const test::FunctionKernel kernel = {.includes = "#include \"math.glsl\"",
                                       .body = R"(
    vec3 n = det_normalize(vec3(input_float(0), input_float(1), input_float(2)), vec3(0.0, 0.0, 7.0));
    output_float(0, n.x); output_float(1, n.y); output_float(2, n.z);)",
                                       .input_count = 3,
                                       .output_count = 3};
  const std::vector<float> outputs = test::run(device, kernel, inputs);
  double worst = 0.0;
  for (std::size_t i = 0; i < inputs.size(); i += 3) {
    const double length = std::hypot(double{inputs[i]}, double{inputs[i + 1]}, double{inputs[i + 2]});
    for (std::size_t k = i; k < i + 3; ++k) worst = std::max(worst, std::abs(outputs[k] - inputs[k] / length));
  }
  // Square, sum, root, reciprocal and product round once each: at most 2 ULP of a component near 1, 2^-24 each.
  CHECK(worst <= 4 * 5.97e-8);

  for (const float bad : {0.0f, 1e-40f, infinity, not_a_number}) {
    const std::vector<float> fallback = test::run(device, kernel, {bad, bad, bad});
    CHECK(fallback == std::vector<float>{0.0f, 0.0f, 7.0f});
  }
}
