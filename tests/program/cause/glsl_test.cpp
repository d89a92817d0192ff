#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include <spirv_cross/GLSL.std.450.h>

#include "tests/program/cause/probe.hpp"

using namespace tandem::program;
using namespace tandem::program::testing;

namespace {

Probe scalars(const char* expression, std::uint32_t glsl) {
  return {"float x; float y; float z; int i;", "float", expression, spv::OpExtInst, glsl};
}

/// The exact result, and neighbours on both sides are wrong.
void check_exact(const Probe& probe, const std::vector<Words>& operands, float right) {
  CAPTURE(right);
  CHECK(blames(probe(operands, floats(right), floats(moved(right, 1))), WrongDevice::b));
  CHECK(blames(probe(operands, floats(moved(right, -1)), floats(right)), WrongDevice::a));
}

using Function = std::function<double(double)>;

struct Domain {
  float low, high;
};

/// Of random operands: what lies within the bound is accepted, and what lies beyond it is not.
/// @param bound of the error, of an operand and the exact result
void check_bound(const Probe& probe, const Function& function, Domain domain,
                 const std::function<double(double, double)>& bound) {
  Random random;
  for (int i = 0; i < 60; ++i) {
    const float x = random.between(domain.low, domain.high);
    const double exact = function(static_cast<double>(x)), allowed = bound(static_cast<double>(x), exact);
    const auto right = static_cast<float>(exact);
    CAPTURE(x);
    CAPTURE(exact);
    CAPTURE(allowed);
    for (const double direction : {-1.0, 1.0}) {
      const auto near = static_cast<float>(exact + direction * allowed * 0.98);
      if (near != right && std::abs(static_cast<double>(near) - exact) <= allowed)
        CHECK(is_within(probe({floats(x)}, floats(right), floats(near))));
      const float far = moved(static_cast<float>(exact + direction * allowed), direction < 0 ? -2 : 2);
      const Judgement judgement = probe({floats(x)}, floats(far), floats(right));
      CHECK(blames(judgement, WrongDevice::a));
      CHECK(judgement.error_a.value() > judgement.allowed.value());
      CHECK(judgement.error_b.value() <= judgement.allowed.value());
      CHECK(judgement.expected->words == floats(right));
    }
  }
}

double ulp(double value) { return std::ldexp(1.0, std::ilogb(value) - 23); }

}  // namespace

TEST_CASE("Rounding functions are exact") {
  const Probe floor = scalars("floor(x)", GLSLstd450Floor), ceil = scalars("ceil(x)", GLSLstd450Ceil);
  const Probe trunc = scalars("trunc(x)", GLSLstd450Trunc), even = scalars("roundEven(x)", GLSLstd450RoundEven);
  const Probe round = scalars("round(x)", GLSLstd450Round), fract = scalars("fract(x)", GLSLstd450Fract);
  const Probe abs = scalars("abs(x)", GLSLstd450FAbs), sign = scalars("sign(x)", GLSLstd450FSign);
  Random random;
  for (int i = 0; i < 30; ++i) {
    const float x = random.between(-20, 20);
    const std::vector<Words> operands = {floats(x)};
    check_exact(floor, operands, std::floor(x));
    check_exact(ceil, operands, std::ceil(x));
    check_exact(trunc, operands, std::trunc(x));
    check_exact(even, operands, std::nearbyint(x));
    check_exact(round, operands, std::nearbyint(x));
    check_exact(abs, operands, std::abs(x));
    check_exact(sign, operands, x < 0 ? -1.0f : 1.0f);
    if (x > 1) check_exact(fract, operands, x - std::floor(x));
  }
  check_exact(even, {floats(2.5)}, 2);
  check_exact(even, {floats(-3.5)}, -4);
  CHECK(is_within(round({floats(2.5)}, floats(2), floats(3))));
  CHECK(is_within(round({floats(-2.5)}, floats(-2), floats(-3))));
  CHECK(is_within(fract({floats(-0x1p-30f)}, floats(1), floats(moved(1.0f, -1)))));
}

TEST_CASE("Minimum, maximum, clamp and step choose exactly") {
  const Probe min = scalars("min(x, y)", GLSLstd450FMin), max = scalars("max(x, y)", GLSLstd450FMax);
  const Probe clamp = scalars("clamp(x, y, z)", GLSLstd450FClamp), step = scalars("step(x, y)", GLSLstd450Step);
  check_exact(min, {floats(1), floats(2)}, 1);
  check_exact(max, {floats(1), floats(2)}, 2);
  check_exact(clamp, {floats(5), floats(1), floats(2)}, 2);
  check_exact(step, {floats(1), floats(1)}, 1);
  CHECK(blames(step({floats(1), floats(0.5)}, floats(0), floats(1)), WrongDevice::b));
  CHECK(is_undefined(min({floats(NAN), floats(2)}, floats(NAN), floats(2))));
  CHECK(is_undefined(max({floats(1), floats(NAN)}, floats(NAN), floats(1))));
  CHECK(is_undefined(clamp({floats(1), floats(3), floats(2)}, floats(3), floats(2))));
  CHECK(is_within(min({floats(0.0), floats(-0.0)}, floats(0.0), floats(-0.0))));
}

TEST_CASE("Functions with a bound of their own") {
  check_bound(
      scalars("inversesqrt(x)", GLSLstd450InverseSqrt), [](double x) { return 1 / std::sqrt(x); }, {0.01f, 90},
      [](double, double exact) { return 2 * ulp(exact); });
  const auto exponential = [](double x, double exact) { return (3 + 2 * std::abs(x)) * ulp(exact); };
  check_bound(
      scalars("exp(x)", GLSLstd450Exp), [](double x) { return std::exp(x); }, {-20, 20}, exponential);
  check_bound(
      scalars("exp2(x)", GLSLstd450Exp2), [](double x) { return std::exp2(x); }, {-20, 20}, exponential);
  const auto logarithmic = [](double x, double exact) { return x >= 0.5 && x <= 2 ? 0x1p-21 : 3 * ulp(exact); };
  check_bound(
      scalars("log(x)", GLSLstd450Log), [](double x) { return std::log(x); }, {0.01f, 8}, logarithmic);
  check_bound(
      scalars("log2(x)", GLSLstd450Log2), [](double x) { return std::log2(x); }, {0.01f, 8}, logarithmic);
  const auto circular = [](double, double) { return 0x1p-11; };
  check_bound(
      scalars("sin(x)", GLSLstd450Sin), [](double x) { return std::sin(x); }, {-3.14f, 3.14f}, circular);
  check_bound(
      scalars("cos(x)", GLSLstd450Cos), [](double x) { return std::cos(x); }, {-3.14f, 3.14f}, circular);
  check_bound(
      scalars("atan(x)", GLSLstd450Atan), [](double x) { return std::atan(x); }, {-5, 5},
      [](double, double exact) { return 4096 * ulp(exact); });
}

TEST_CASE("A wrongly rounded root is detected") {
  Random random;
  const Probe root = scalars("sqrt(x)", GLSLstd450Sqrt);
  for (int i = 0; i < 50; ++i) {
    const float x = random.between(0.001f, 1000), right = std::sqrt(x);
    CHECK(is_within(root({floats(x)}, floats(right), floats(moved(right, 3)))));
    CHECK(blames(root({floats(x)}, floats(right), floats(moved(right, 9))), WrongDevice::b));
    CHECK(blames(root({floats(x)}, floats(moved(right, -9)), floats(right)), WrongDevice::a));
  }
  CHECK(blames(root({floats(0)}, floats(0), floats(1e-20)), WrongDevice::b));
  const Judgement judgement = root({floats(2)}, floats(std::sqrt(2.0)), floats(1.5));
  CHECK(judgement.allowed.value() > 4);
  CHECK(judgement.allowed.value() < 7);
  CHECK(judgement.reason.find("sqrt may err by") == 0);
  const Probe wide_root("double x;", "double", "sqrt(x)", spv::OpExtInst, GLSLstd450Sqrt);
  CHECK(is_within(wide_root({wide(2.0)}, wide(std::sqrt(2.0)), wide(moved(std::sqrt(2.0), 2)))));
  CHECK(blames(wide_root({wide(2.0)}, wide(std::sqrt(2.0)), wide(moved(std::sqrt(2.0), 12))), WrongDevice::b));
}

TEST_CASE("Functions that inherit their bound accept single precision's own results, and no gross error") {
  struct Inheriting {
    const char* expression;
    std::uint32_t glsl;
    float (*function)(float);
    Domain domain;
    float gross;  ///< relative
  };
  const Inheriting all[] = {
      {"tan(x)", GLSLstd450Tan, std::tan, {-1, 1}, 0.02f},
      {"asin(x)", GLSLstd450Asin, std::asin, {-0.95f, 0.95f}, 0.01f},
      {"acos(x)", GLSLstd450Acos, std::acos, {-0.95f, 0.95f}, 0.01f},
      {"sinh(x)", GLSLstd450Sinh, std::sinh, {1, 20}, 0.001f},
      {"cosh(x)", GLSLstd450Cosh, std::cosh, {-20, 20}, 0.001f},
      {"tanh(x)", GLSLstd450Tanh, std::tanh, {0.5f, 20}, 0.001f},
      {"asinh(x)", GLSLstd450Asinh, std::asinh, {1, 100}, 0.001f},
      {"acosh(x)", GLSLstd450Acosh, std::acosh, {1.5f, 100}, 0.001f},
      {"atanh(x)", GLSLstd450Atanh, std::atanh, {0.3f, 0.9f}, 0.001f},
  };
  Random random;
  for (const Inheriting& each : all) {
    CAPTURE(each.expression);
    const Probe probe = scalars(each.expression, each.glsl);
    for (int i = 0; i < 20; ++i) {
      const float x = random.between(each.domain.low, each.domain.high), right = each.function(x);
      CAPTURE(x);
      CHECK(is_within(probe({floats(x)}, floats(right), floats(moved(right, 1)))));
      CHECK(blames(probe({floats(x)}, floats(right), floats(right * (1 + each.gross))), WrongDevice::b));
      CHECK(blames(probe({floats(x)}, floats(right * (1 - each.gross)), floats(-right)), WrongDevice::both));
    }
  }
}

TEST_CASE("pow and atan2 have two operands") {
  Random random;
  const Probe pow = scalars("pow(x, y)", GLSLstd450Pow), angle = scalars("atan(x, y)", GLSLstd450Atan2);
  for (int i = 0; i < 30; ++i) {
    const float x = random.between(0.1f, 10), y = random.between(-4, 4);
    const float power = std::pow(x, y), turn = std::atan2(x - 5, y);
    CHECK(is_within(pow({floats(x), floats(y)}, floats(power), floats(moved(power, 2)))));
    CHECK(blames(pow({floats(x), floats(y)}, floats(power), floats(power * 1.001f)), WrongDevice::b));
    CHECK(is_within(angle({floats(x - 5), floats(y)}, floats(turn), floats(moved(turn, 3000)))));
    CHECK(blames(angle({floats(x - 5), floats(y)}, floats(turn), floats(turn + std::numbers::pi_v<float>)),
                 WrongDevice::b));
  }
  CHECK(blames(pow({floats(0), floats(2)}, floats(0), floats(1)), WrongDevice::b));
  CHECK(is_within(angle({floats(-0.0), floats(-1)}, floats(-std::numbers::pi), floats(std::numbers::pi))));
}

TEST_CASE("Outside of their domains, functions are undefined") {
  const auto undefined = [](const char* expression, std::uint32_t glsl, auto... operands) {
    return is_undefined(scalars(expression, glsl)({floats(operands)...}, floats(1), floats(2)));
  };
  CHECK(undefined("sqrt(x)", GLSLstd450Sqrt, -1));
  CHECK(undefined("inversesqrt(x)", GLSLstd450InverseSqrt, 0));
  CHECK(undefined("log(x)", GLSLstd450Log, 0));
  CHECK(undefined("log(x)", GLSLstd450Log, 0x1p-140));  // flushed
  CHECK(undefined("log2(x)", GLSLstd450Log2, -1));
  CHECK(undefined("asin(x)", GLSLstd450Asin, 1.5));
  CHECK(undefined("acos(x)", GLSLstd450Acos, -1.5));
  CHECK(undefined("acosh(x)", GLSLstd450Acosh, 0.5));
  CHECK(undefined("atanh(x)", GLSLstd450Atanh, 1));
  CHECK(undefined("pow(x, y)", GLSLstd450Pow, -1, 2));
  CHECK(undefined("pow(x, y)", GLSLstd450Pow, 0, 0));
  CHECK(undefined("atan(x, y)", GLSLstd450Atan2, 0, 0));
  CHECK(undefined("smoothstep(x, y, z)", GLSLstd450SmoothStep, 1, 1, 0.5));
  const Judgement judgement = scalars("sin(x)", GLSLstd450Sin)({floats(100)}, floats(-0.5), floats(0.7));
  CHECK(is_within(judgement));
  CHECK(judgement.reason.find("[-pi, pi]") != std::string::npos);
}

TEST_CASE("mix, smoothstep, fma, radians and degrees inherit from sums and products") {
  Random random;
  const Probe mix = scalars("mix(x, y, z)", GLSLstd450FMix),
              smooth = scalars("smoothstep(x, y, z)", GLSLstd450SmoothStep);
  const Probe fma = scalars("fma(x, y, z)", GLSLstd450Fma);
  for (int i = 0; i < 50; ++i) {
    const float x = random.between(-2, 2), y = random.between(-2, 2), z = random.between(0, 1);
    const std::vector<Words> operands = {floats(x), floats(y), floats(z)};
    const float one = x * (1 - z) + y * z, other = x + (y - x) * z;
    if (one != other) CHECK(is_within(mix(operands, floats(one), floats(other))));
    CHECK(blames(mix(operands, floats(one), floats(y * (1 - z) + x * z + 0.001f)), WrongDevice::b));
    const float separate = x * y + z, fused = std::fma(x, y, z);
    if (separate != fused) CHECK(is_within(fma(operands, floats(separate), floats(fused))));
    CHECK(blames(fma(operands, floats(separate), floats(fused + 1e-5)), WrongDevice::b));
    const std::vector<Words> edges = {floats(-3), floats(3), floats(x)};
    const float t = (x + 3) / 6, right = t * t * (3 - 2 * t);
    CHECK(is_within(smooth(edges, floats(right), floats(moved(right, 1)))));
    CHECK(blames(smooth(edges, floats(right), floats(right + 1e-4)), WrongDevice::b));
  }
  const Probe radians = scalars("radians(x)", GLSLstd450Radians), degrees = scalars("degrees(x)", GLSLstd450Degrees);
  const auto half_turn = std::numbers::pi_v<float>;
  CHECK(is_within(radians({floats(180)}, floats(half_turn), floats(moved(half_turn, 1)))));
  CHECK(blames(radians({floats(180)}, floats(half_turn), floats(moved(half_turn, 8))), WrongDevice::b));
  CHECK(blames(degrees({floats(1)}, floats(57.29578), floats(57.2959)), WrongDevice::b));
}

TEST_CASE("frexp, modf and ldexp take floats apart exactly") {
  const Probe frexp = scalars("frexp(x, i)", GLSLstd450FrexpStruct);
  const Words right = {floats(0.75)[0], 4};
  CHECK(blames(frexp({floats(12)}, right, {floats(0.75)[0], 5}), WrongDevice::b));
  CHECK(blames(frexp({floats(12)}, {floats(1.5)[0], 3}, right), WrongDevice::a));
  CHECK(is_within(frexp({floats(0x1p-130f)}, {floats(0.5)[0], static_cast<std::uint32_t>(-129)}, {0, 0})));
  CHECK(is_undefined(frexp({floats(INFINITY)}, right, {0, 0})));
  const Probe modf = scalars("modf(x, y)", GLSLstd450Modf);  // the whole part goes through a pointer
  check_exact(modf, {floats(-2.75)}, -0.75);
  CHECK(blames(modf({floats(2.75)}, floats(0.75), floats(-0.25)), WrongDevice::b));
  const Probe ldexp = scalars("ldexp(x, i)", GLSLstd450Ldexp);
  const auto power = [](int exponent) { return Words{static_cast<std::uint32_t>(exponent)}; };
  check_exact(ldexp, {floats(1.5), power(3)}, 12);
  CHECK(is_undefined(ldexp({floats(1), power(200)}, floats(1), floats(INFINITY))));
  CHECK(is_undefined(ldexp({floats(4), power(127)}, floats(1), floats(INFINITY))));
  CHECK(is_within(ldexp({floats(0x1p20f), power(-127)}, floats(0x1p-107f), floats(0))));
  CHECK(blames(ldexp({floats(0x1p20f), power(-126)}, floats(0x1p-106f), floats(0)), WrongDevice::b));
}

TEST_CASE("16 bits have bounds of their own") {
  const Probe exp("float16_t x;", "float16_t", "exp(x)", spv::OpExtInst, GLSLstd450Exp);
  // exp(1) = 2.71875 up to 16 bits, of 2^-9 each; 3 of them are allowed.
  const float right = 2.71875f, unit = 0x1p-9f;
  CHECK(is_within(exp({floats(1)}, floats(right), floats(right + 2 * unit))));
  CHECK(blames(exp({floats(1)}, floats(right), floats(right + 4 * unit)), WrongDevice::b));
  const Probe sin("float16_t x;", "float16_t", "sin(x)", spv::OpExtInst, GLSLstd450Sin);
  CHECK(is_within(sin({floats(1)}, floats(0.8413), floats(0.8359))));
  CHECK(blames(sin({floats(1)}, floats(0.8413), floats(0.8281)), WrongDevice::b));
}

TEST_CASE("A function without a bound at its operand is within precision, with the reason") {
  const Probe tanh = scalars("tanh(x)", GLSLstd450Tanh), tan = scalars("tan(x)", GLSLstd450Tan);
  CHECK(is_within(tanh({floats(100)}, floats(1), floats(NAN))));  // infinity / infinity, by the formula
  CHECK(is_within(tan({floats(std::numbers::pi / 2)}, floats(1e7), floats(-2e7))));
  CHECK(is_within(scalars("exp(x)", GLSLstd450Exp)({floats(100)}, floats(INFINITY), floats(3e38))));
}
