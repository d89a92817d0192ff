// 16-bit floats. All 65,536 of them go through every function of one operand; pairs are drawn.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/rhi_cpu/translate/half_reference.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::test::half_distance;
using tandem::test::half_value;
using tandem::test::is_half_nan;
using tandem::test::Kernel;
using tandem::test::KernelOptions;
using tandem::test::nearest_half;
using tandem::test::resource;
using tandem::test::rounded_to_half;

constexpr std::size_t half_count = 65536;

const char* const extensions =
    "#extension GL_EXT_shader_explicit_arithmetic_types : require\n"
    "#extension GL_EXT_shader_16bit_storage : require\n";

std::uint16_t bits_of(std::size_t i) { return static_cast<std::uint16_t>(i); }

/// A function of one half: its GLSL of x, its value in double, and how far from the nearest half it may be.
struct Unary {
  const char* glsl;
  std::function<double(double)> exact;
  int distance = 0;
};

// Computed in float: what is within an ulp or two of a float can be on the other side of a tie between two halves.
constexpr int across_a_tie = 1;

int ignored_exponent;

const char* const split_functions =
    "float16_t fraction(float16_t x) { float16_t whole; return modf(x, whole); }\n"
    "float16_t significand(float16_t x) { int exponent; return frexp(x, exponent); }\n";

const std::vector<Unary> unary_functions = {
    {"x", [](double x) { return x; }},
    {"-x", [](double x) { return -x; }},
    {"(-f16vec4(1, 2, 3, x)).w", [](double x) { return -x; }},
    {"abs(x)", [](double x) { return std::fabs(x); }},
    {"sign(x)", [](double x) { return x > 0   ? 1.0
                                      : x < 0 ? -1.0
                                              : 0.0; }},
    {"floor(x)", [](double x) { return std::floor(x); }},
    {"ceil(x)", [](double x) { return std::ceil(x); }},
    {"trunc(x)", [](double x) { return std::trunc(x); }},
    {"roundEven(x)", [](double x) { return std::nearbyint(x); }},
    {"fract(x)", [](double x) { return x - std::floor(x); }},
    {"x * x", [](double x) { return x * x; }},
    {"float16_t(1) / x", [](double x) { return 1.0 / x; }},
    {"sqrt(x)", [](double x) { return std::sqrt(x); }},
    {"float16_t(float(x) * 1.0009765625f)", [](double x) { return x * 1.0009765625; }},
    {"float16_t(double(x) * 1.0000000001lf)", [](double x) { return x * 1.0000000001; }},
    {"float16_t(double(x) * 1.00048828125lf)", [](double x) { return x * 1.00048828125; }},
    {"inversesqrt(x)", [](double x) { return 1.0 / std::sqrt(x); }, across_a_tie},
    {"sin(x)", [](double x) { return std::sin(x); }, across_a_tie},
    {"cos(x)", [](double x) { return std::cos(x); }, across_a_tie},
    {"tan(x)", [](double x) { return std::tan(x); }, across_a_tie},
    {"asin(x)", [](double x) { return std::asin(x); }, across_a_tie},
    {"acos(x)", [](double x) { return std::acos(x); }, across_a_tie},
    {"atan(x)", [](double x) { return std::atan(x); }, across_a_tie},
    {"sinh(x)", [](double x) { return std::sinh(x); }, across_a_tie},
    {"cosh(x)", [](double x) { return std::cosh(x); }, across_a_tie},
    {"tanh(x)", [](double x) { return std::tanh(x); }, across_a_tie},
    {"asinh(x)", [](double x) { return std::asinh(x); }, across_a_tie},
    {"acosh(x)", [](double x) { return std::acosh(x); }, across_a_tie},
    {"atanh(x)", [](double x) { return std::atanh(x); }, across_a_tie},
    {"exp(x)", [](double x) { return std::exp(x); }, across_a_tie},
    {"exp2(x)", [](double x) { return std::exp2(x); }, across_a_tie},
    {"log(x)", [](double x) { return std::log(x); }, across_a_tie},
    {"log2(x)", [](double x) { return std::log2(x); }, across_a_tie},
    // The factor is a half, which is the nearest to pi / 180.
    {"radians(x)", [](double x) { return x * rounded_to_half(0.017453292519943295); }},
    {"fraction(x)", [](double x) { return std::copysign(std::isinf(x) ? 0.0 : x - std::trunc(x), x); }},
    {"significand(x)", [](double x) { return std::isinf(x) ? x : std::frexp(x, &ignored_exponent); }},
    {"degrees(x)", [](double x) { return x * rounded_to_half(57.29577951308232); }},
};

std::vector<std::uint16_t> all_halves() {
  std::vector<std::uint16_t> halves(half_count);
  for (std::size_t i = 0; i < half_count; ++i) halves[i] = bits_of(i);
  return halves;
}

void check_unary(const std::vector<Unary>& functions, const KernelOptions& options) {
  std::string source = extensions +
                       std::string(
                           "layout(local_size_x = 64) in;\n"
                           "layout(std430, binding = 0) buffer In { float16_t values[]; };\n"
                           "layout(std430, binding = 1) buffer Out { float16_t results[]; };\n") +
                       split_functions + "void main() {\n  uint i = gl_GlobalInvocationID.x;\n" +
                       std::string("  float16_t x = values[i];\n");
  for (std::size_t f = 0; f < functions.size(); ++f)
    source += "  results[i + " + std::to_string(half_count * f) + "] = " + functions[f].glsl + ";\n";
  std::vector<std::uint16_t> values = all_halves(), results(half_count * functions.size());
  Kernel(source + "}\n", options).run({resource(values), resource(results)}, {half_count / 64});
  for (std::size_t f = 0; f < functions.size(); ++f) {
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < half_count; ++i) {
      const std::uint16_t result = results[half_count * f + i];
      const std::uint16_t expected = nearest_half(functions[f].exact(half_value(values[i])));
      if (half_distance(result, expected) <= functions[f].distance) continue;
      if (wrong++ == 0) MESSAGE(functions[f].glsl, " of bits ", i, " is ", result, ", not ", expected);
    }
    CAPTURE(functions[f].glsl);
    CHECK(wrong == 0);
  }
}

TEST_CASE("functions of every half are rounded once") { check_unary(unary_functions, {}); }

TEST_CASE("conversions give the same halves with the instructions of F16C") {
#ifdef __x86_64__
  if (!__builtin_cpu_supports("avx2")) return;  // Clang 14 cannot ask for F16C, which all of these have.
  const KernelOptions options = {.specialization = {}, .more_options = {"-mf16c"}};
  check_unary({unary_functions.begin(), unary_functions.begin() + 16}, options);
#endif
}

/// Halves of every magnitude, and the special ones.
std::vector<std::uint16_t> drawn_halves(std::size_t count, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::vector<std::uint16_t> halves = {0,      0x8000, 1,      0x83ff, 0x0400, 0x3c00,
                                       0xbc00, 0x7bff, 0xfbff, 0x7c00, 0xfc00, 0x7e00};
  // Half of them within a few powers of two of 1, where sums are not trivial.
  while (halves.size() < count) {
    const auto bits = static_cast<std::uint32_t>(generator());
    halves.push_back(static_cast<std::uint16_t>((bits & 0x10000) != 0 ? bits : (bits & 0x9fff) + 0x2800));
  }
  std::shuffle(halves.begin(), halves.end(), generator);
  return halves;
}

double h(double x) { return rounded_to_half(x); }

struct Ternary {
  const char* glsl;
  std::function<double(double, double, double)> exact;  ///< with h() around each operation but the last
  int distance = 0;
};

double smaller(double a, double b) { return std::isnan(a) || b < a ? b : a; }
double larger(double a, double b) { return std::isnan(a) || a < b ? b : a; }

const std::vector<Ternary> ternary_functions = {
    {"a + b", [](double a, double b, double) { return a + b; }},
    {"a - b", [](double a, double b, double) { return a - b; }},
    {"a * b", [](double a, double b, double) { return a * b; }},
    {"a / b", [](double a, double b, double) { return a / b; }},
    {"fma(a, b, c)", [](double a, double b, double c) { return h(a * b) + c; }},
    {"mod(a, b)", [](double a, double b, double) { return a - h(b * std::floor(h(a / b))); }},
    {"min(a, b)", [](double a, double b, double) { return smaller(a, b); }},
    {"max(a, b)", [](double a, double b, double) { return larger(a, b); }},
    {"clamp(a, b, c)", [](double a, double b, double c) { return smaller(larger(a, b), c); }},
    {"step(a, b)", [](double a, double b, double) { return b < a ? 0.0 : 1.0; }},
    {"mix(a, b, c)", [](double a, double b, double c) { return h(a * h(1 - c)) + h(b * c); }},
    {"smoothstep(a, b, c)",
     [](double a, double b, double c) {
       const double t = smaller(larger(h(h(c - a) / h(b - a)), 0.0), 1.0);
       return t * h(t * h(3 - h(2 * t)));
     }},
    {"dot(f16vec3(a, b, c), f16vec3(c, a, b))",
     [](double a, double b, double c) { return h(h(a * c) + h(b * a)) + h(c * b); }},
    {"length(f16vec2(a, b))", [](double a, double b, double) { return std::sqrt(h(h(a * a) + h(b * b))); }},
    {"distance(a, b)", [](double a, double b, double) { return std::fabs(a - b); }},
    {"normalize(f16vec2(a, b)).y", [](double a, double b, double) { return b / h(std::sqrt(h(h(a * a) + h(b * b)))); }},
    {"cross(f16vec3(a, b, c), f16vec3(b, c, a)).x", [](double a, double b, double c) { return h(b * a) - h(c * c); }},
    {"reflect(f16vec2(a, b), f16vec2(c, a)).x",
     [](double a, double b, double c) { return a - h(c * h(2 * h(h(c * a) + h(a * b)))); }},
    {"faceforward(f16vec2(a, b), f16vec2(b, c), f16vec2(c, c)).x",
     [](double a, double b, double c) { return h(h(c * b) + h(c * c)) < 0 ? a : -a; }},
    {"(f16mat2x2(a, b, c, a) * f16vec2(b, c)).y", [](double a, double b, double c) { return h(b * b) + h(a * c); }},
    {"(f16vec2(a, b) * f16mat2x2(a, b, c, a)).y", [](double a, double b, double c) { return h(a * c) + h(b * a); }},
    // Rounded once: a difference of products loses most of a half's bits otherwise.
    {"determinant(f16mat2x2(a, b, c, a))", [](double a, double b, double c) { return a * a - c * b; }, across_a_tie},
    {"determinant(f16mat3x3(a, 0, 0, 0, b, c, 0, c, a))",
     [](double a, double b, double c) {  // what is infinite makes the zeros count
       return a * (b * a - c * c) - 0 * (0 * a - c * 0) + 0 * (0 * c - b * 0);
     },
     across_a_tie},
    {"inverse(f16mat2x2(a, b, c, a))[0].x", [](double a, double b, double c) { return a / (a * a - c * b); },
     across_a_tie},
    {"refract(f16vec2(a, b), f16vec2(b, c), c).x",
     [](double a, double b, double c) {
       const double cosine = h(h(b * a) + h(c * b));
       const double k = h(1 - h(c * h(c * h(1 - h(cosine * cosine)))));
       return k < 0 ? 0.0 : h(a * c) - h(b * h(h(c * cosine) + h(std::sqrt(k))));
     }},
    {"transpose(f16mat2x3(a, b, c, a, b, c) + f16mat2x3(b, a, b, c, b, c))[1].x",
     [](double a, double b, double) { return b + a; }},
    {"ldexp(a, int(clamp(b, float16_t(-40), float16_t(40))))",
     [](double a, double b, double) { return std::ldexp(a, static_cast<int>(smaller(larger(b, -40), 40))); }},
    {"a < b ? c : a", [](double a, double b, double c) { return a < b ? c : a; }},
    {"float16_t((a == b ? 1 : 0) + (a != b ? 2 : 0) + (a <= b ? 4 : 0) + (a > b ? 8 : 0) + (a >= b ? 16 : 0))",
     [](double a, double b, double) {
       return (a == b ? 1 : 0) + (a != b ? 2 : 0) + (a <= b ? 4 : 0) + (a > b ? 8 : 0) + (a >= b ? 16 : 0);
     }},
    {"float16_t((isnan(a) ? 1 : 0) + (isinf(b) ? 2 : 0) + int(dot(vec2(lessThan(f16vec2(a, c), f16vec2(b, a))), "
     "vec2(4, 8))))",
     [](double a, double b, double c) {
       return (std::isnan(a) ? 1 : 0) + (std::isinf(b) ? 2 : 0) + (a < b ? 4 : 0) + (c < a ? 8 : 0);
     }},
    {"pow(a, b)", [](double a, double b, double) { return std::pow(a, b); }, across_a_tie},
    {"atan(a, b)", [](double a, double b, double) { return std::atan2(a, b); }, across_a_tie},
};

TEST_CASE("every operation of two and three halves rounds") {
  constexpr std::size_t count = 16384;
  std::string source = extensions + std::string(
                                        "layout(local_size_x = 64) in;\n"
                                        "layout(std430, binding = 0) buffer In { float16_t values[]; };\n"
                                        "layout(std430, binding = 1) buffer Out { float16_t results[]; };\n"
                                        "void main() {\n  uint i = gl_GlobalInvocationID.x;\n"
                                        "  float16_t a = values[i], b = values[i + 16384], c = values[i + 32768];\n");
  for (std::size_t f = 0; f < ternary_functions.size(); ++f)
    source += "  results[i + " + std::to_string(count * f) + "] = " + ternary_functions[f].glsl + ";\n";
  std::vector<std::uint16_t> values;
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const std::vector<std::uint16_t> drawn = drawn_halves(count, seed);
    values.insert(values.end(), drawn.begin(), drawn.end());
  }
  std::vector<std::uint16_t> results(count * ternary_functions.size());
  Kernel(source + "}\n").run({resource(values), resource(results)}, {count / 64});
  for (std::size_t f = 0; f < ternary_functions.size(); ++f) {
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double a = half_value(values[i]), b = half_value(values[i + count]), c = half_value(values[i + 2 * count]);
      const std::uint16_t result = results[count * f + i];
      const std::uint16_t expected = nearest_half(ternary_functions[f].exact(a, b, c));
      if (half_distance(result, expected) <= ternary_functions[f].distance) continue;
      if (wrong++ == 0) MESSAGE(ternary_functions[f].glsl, ", ", a, " ", b, " ", c, ": ", result, ", not ", expected);
    }
    CAPTURE(ternary_functions[f].glsl);
    CHECK(wrong == 0);
  }
}

}  // namespace
