#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/program/cause/probe.hpp"

using namespace tandem::program;
using namespace tandem::program::testing;

namespace {

/// A result that is rounded to nearest is right, its neighbour on the other side of the exact value is too, and no
/// other float is. @param exact in enough digits
void check_rounded(const Probe& probe, const std::vector<Words>& operands, float right, long double exact) {
  CAPTURE(right);
  const auto blamed = [&](float wrong) {
    return blames(probe(operands, floats(right), floats(wrong)), WrongDevice::b);
  };
  if (static_cast<long double>(right) == exact) {
    CHECK(blamed(moved(right, 1)));
    CHECK(blamed(moved(right, -1)));
  } else {
    const int towards = static_cast<long double>(right) < exact ? 1 : -1;
    CHECK(is_within(probe(operands, floats(right), floats(moved(right, towards)))));
    CHECK(blamed(moved(right, -towards)));
    CHECK(blamed(moved(right, 2 * towards)));
  }
  const Judgement judgement = probe(operands, floats(moved(right, 3)), floats(moved(right, 5)));
  CHECK(blames(judgement, WrongDevice::both));
  REQUIRE(judgement.expected);
  CHECK(judgement.expected->words == floats(right));
}

Probe scalars(const char* expression, spv::Op op, const Extras& extras = {}) {
  return {"float x; float y; float z;", "float", expression, op, 0, extras};
}

}  // namespace

TEST_CASE("Sums and products of floats are correctly rounded, in either direction") {
  Random random;
  const Probe sum = scalars("x + y", spv::OpFAdd), difference = scalars("x - y", spv::OpFSub);
  const Probe product = scalars("x * y", spv::OpFMul);
  for (int i = 0; i < 100; ++i) {
    const int range = i % 3 == 0 ? 2 : i % 3 == 1 ? 12 : 60;
    const float x = random.real(range), y = random.real(range);
    const std::vector<Words> operands = {floats(x), floats(y)};
    // 64 bits do not hold all sums, but with 60 exponents between the operands they do not round to one of them.
    if (std::abs(std::ilogb(x) - std::ilogb(y)) < 38) {
      check_rounded(sum, operands, x + y, static_cast<long double>(x) + y);
      check_rounded(difference, operands, x - y, static_cast<long double>(x) - y);
    }
    check_rounded(product, operands, x * y, static_cast<long double>(x) * y);
  }
}

TEST_CASE("A sum knows a tail that is too small for any number") {
  const Probe sum = scalars("x + y", spv::OpFAdd);
  const std::vector<Words> operands = {floats(1), floats(0x1p-126f)};
  CHECK(is_within(sum(operands, floats(1), floats(moved(1.0f, 1)))));
  CHECK(blames(sum(operands, floats(1), floats(moved(1.0f, -1))), WrongDevice::b));
}

TEST_CASE("A subtraction of floats with swapped operands is detected") {
  const Probe difference = scalars("x - y", spv::OpFSub);
  const Judgement judgement = difference({floats(0.3), floats(0.1)}, floats(0.3f - 0.1f), floats(0.1f - 0.3f));
  CHECK(blames(judgement, WrongDevice::b));
  CHECK(judgement.error_b.value() > 1e6);
  CHECK(judgement.error_a.value() <= 0.5);
}

TEST_CASE("Sums and products of 64 bits are correctly rounded") {
  Random random;
  const std::string members = "double x; double y;";
  const Probe sum(members, "double", "x + y", spv::OpFAdd), product(members, "double", "x * y", spv::OpFMul);
  for (int i = 0; i < 50; ++i) {
    const double x = random.long_real(20), y = random.long_real(20);
    const std::vector<Words> operands = {wide(x), wide(y)};
    for (const auto& [probe, right] : {std::pair(&sum, x + y), std::pair(&product, x * y)}) {
      const int accepted = static_cast<int>(is_within((*probe)(operands, wide(right), wide(moved(right, 1))))) +
                           static_cast<int>(is_within((*probe)(operands, wide(right), wide(moved(right, -1)))));
      CHECK(accepted <= 1);
      CHECK(blames((*probe)(operands, wide(moved(right, 2)), wide(right)), WrongDevice::a));
      CHECK((*probe)(operands, wide(moved(right, 2)), wide(right)).expected->words == wide(right));
    }
  }
}

TEST_CASE("Sums and products of 16 bits are correctly rounded") {
  const std::string members = "float16_t x; float16_t y;";
  const Probe sum(members, "float16_t", "x + y", spv::OpFAdd), product(members, "float16_t", "x * y", spv::OpFMul);
  const float unit = 0x1p-10f;
  // 1 + 2^-12: 1 or 1 + unit
  CHECK(is_within(sum({floats(1), floats(0x1p-12f)}, floats(1), floats(1 + unit))));
  CHECK(blames(sum({floats(1), floats(0x1p-12f)}, floats(1), floats(1 + 2 * unit)), WrongDevice::b));
  CHECK(blames(sum({floats(1), floats(0x1p-10f)}, floats(1), floats(1 + unit)), WrongDevice::a));
  CHECK(blames(product({floats(3), floats(5)}, floats(15), floats(15 + 8 * unit)), WrongDevice::b));
}

TEST_CASE("A quotient may err by 2.5 ulp") {
  Random random;
  const Probe quotient = scalars("x / y", spv::OpFDiv);
  for (int i = 0; i < 100; ++i) {
    const float x = random.real(30), y = random.real(30), right = x / y;
    const std::vector<Words> operands = {floats(x), floats(y)};
    CHECK(is_within(quotient(operands, floats(moved(right, 2)), floats(right))));
    CHECK(blames(quotient(operands, floats(moved(right, 6)), floats(right)), WrongDevice::a));
    CHECK(blames(quotient(operands, floats(right), floats(moved(right, -6))), WrongDevice::b));
  }
  const Judgement judgement = quotient({floats(1), floats(3)}, floats(1.0f / 3), floats(0.4));
  CHECK(judgement.allowed.value() == doctest::Approx(2.5).epsilon(0.01));
  CHECK(is_within(quotient({floats(1), floats(0x1p127f)}, floats(0), floats(1))));
  CHECK(is_within(quotient({floats(1), floats(0)}, floats(INFINITY), floats(1))));
  CHECK(is_undefined(quotient({floats(0), floats(0)}, floats(NAN), floats(1))));
}

TEST_CASE("A negation is exact") {
  const Probe negation = scalars("-x", spv::OpFNegate);
  CHECK(blames(negation({floats(1.5)}, floats(-1.5), floats(moved(-1.5f, 1))), WrongDevice::b));
  CHECK(is_within(negation({floats(0)}, floats(0.0), floats(-0.0))));
  CHECK(is_within(negation({floats(0x1p-140f)}, floats(-0x1p-140f), floats(0))));
}

TEST_CASE("mod and remainder inherit the error of the quotient") {
  const Probe mod = scalars("mod(x, y)", spv::OpFMod);
  const Probe remainder = mod.with(spv::OpFRem);
  CHECK(blames(mod({floats(7.5), floats(2)}, floats(1.5), floats(-0.5)), WrongDevice::b));
  CHECK(blames(mod({floats(-7.5), floats(2)}, floats(0.5), floats(-1.5)), WrongDevice::b));
  CHECK(blames(remainder({floats(-7.5), floats(2)}, floats(0.5), floats(-1.5)), WrongDevice::a));
  CHECK(mod({floats(-7.5), floats(2)}, floats(0), floats(1)).expected->words == floats(0.5));
  // 6 / 2 may be a little less than 3: the specification's own example.
  CHECK(is_within(mod({floats(6), floats(2)}, floats(0), floats(2))));
  CHECK(is_undefined(mod({floats(6), floats(0)}, floats(0), floats(2))));
}

TEST_CASE("Vectors and matrices are judged component by component") {
  const Probe scaled("vec3 v; float s;", "vec3", "v * s", spv::OpVectorTimesScalar);
  const Words v = floats(1, 2, 3);
  CHECK(blames(scaled({v, floats(2)}, floats(2, 4, 6), floats(2, 4, moved(6.0f, 1))), WrongDevice::b));
  CHECK(blames(scaled({v, floats(2)}, floats(2, 5, 6), floats(2, 4, 7)), WrongDevice::both));
  const Probe product("mat2 m; vec2 v;", "vec2", "m * v", spv::OpMatrixTimesVector);
  // Columns (1, 2) and (3, 4).
  CHECK(blames(product({floats(1, 2, 3, 4), floats(5, 6)}, floats(23, 34), floats(17, 39)), WrongDevice::b));
  const Probe transposed("mat2 m; vec2 v;", "vec2", "v * m", spv::OpVectorTimesMatrix);
  CHECK(blames(transposed({floats(5, 6), floats(1, 2, 3, 4)}, floats(23, 34), floats(17, 39)), WrongDevice::a));
  const Probe matrices("mat2 m; mat2 n;", "mat2", "m * n", spv::OpMatrixTimesMatrix);
  CHECK(blames(matrices({floats(1, 2, 3, 4), floats(5, 6, 7, 8)}, floats(23, 34, 31, 46), floats(19, 22, 43, 50)),
               WrongDevice::b));
  const Probe outer("vec2 x; vec2 y;", "mat2", "outerProduct(x, y)", spv::OpOuterProduct);
  CHECK(blames(outer({floats(1, 2), floats(3, 4)}, floats(3, 6, 4, 8), floats(3, 4, 6, 8)), WrongDevice::b));
  const Probe by_scalar("mat2 m; float s;", "mat2", "m * s", spv::OpMatrixTimesScalar);
  CHECK(blames(by_scalar({floats(1, 2, 3, 4), floats(2)}, floats(2, 4, 6, 8), floats(2, 4, 6, 9)), WrongDevice::b));
}

TEST_CASE("A dot product may be summed in any order") {
  Random random;
  const Probe dot("vec4 x; vec4 y;", "float", "dot(x, y)", spv::OpDot);
  for (int i = 0; i < 100; ++i) {
    std::array<float, 4> x, y, p;
    double exact = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      x[k] = random.between(-1, 1);
      y[k] = random.between(-1, 1);
      p[k] = x[k] * y[k];
      exact += static_cast<double>(x[k]) * y[k];
    }
    const std::vector<Words> operands = {floats(x[0], x[1], x[2], x[3]), floats(y[0], y[1], y[2], y[3])};
    const float forward = p[0] + p[1] + p[2] + p[3], backward = p[3] + p[2] + p[1] + p[0];
    const float pairs = (p[0] + p[2]) + (p[1] + p[3]);
    const float fused = std::fma(x[0], y[0], std::fma(x[1], y[1], std::fma(x[2], y[2], p[3])));
    for (const float result : {backward, pairs, fused})
      if (result != forward) CHECK(is_within(dot(operands, floats(forward), floats(result))));
    CHECK(blames(dot(operands, floats(forward), floats(exact + 1e-5)), WrongDevice::b));
  }
  // Small integers are exact in every order.
  CHECK(blames(dot({floats(1, 2, 3, 4), floats(5, 6, 7, 8)}, floats(70), floats(moved(70.0f, 1))), WrongDevice::b));
}

TEST_CASE("Comparisons are exact, but for NaN and flushed denormals") {
  const Probe less("float x; float y;", "uint", "uint(x < y)", spv::OpFOrdLessThan);
  CHECK(blames(less({floats(1), floats(2)}, {1}, {0}), WrongDevice::b));
  CHECK(blames(less({floats(2), floats(2)}, {1}, {0}), WrongDevice::a));
  CHECK(blames(less.with(spv::OpFOrdLessThanEqual)({floats(2), floats(2)}, {1}, {0}), WrongDevice::b));
  CHECK(blames(less.with(spv::OpFUnordGreaterThan)({floats(1), floats(2)}, {1}, {0}), WrongDevice::a));
  CHECK(blames(less.with(spv::OpFOrdEqual)({floats(0.0), floats(-0.0)}, {1}, {0}), WrongDevice::b));
  CHECK(is_within(less({floats(0), floats(0x1p-130f)}, {1}, {0})));
  CHECK(is_undefined(less({floats(NAN), floats(1)}, {1}, {0})));
  CHECK(is_within(less({floats(1), floats(INFINITY)}, {1}, {0})));
  const Probe is_nan("float x;", "uint", "uint(isnan(x))", spv::OpIsNan);
  CHECK(blames(is_nan({floats(1)}, {0}, {1}), WrongDevice::b));
  CHECK(is_within(is_nan({floats(NAN)}, {0}, {1})));
  CHECK(blames(is_nan.with(spv::OpIsInf)({floats(1)}, {1}, {0}), WrongDevice::a));
}
