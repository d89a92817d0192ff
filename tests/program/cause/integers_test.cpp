#include <doctest/doctest.h>

#include <bit>
#include <functional>
#include <limits>

#include <spirv_cross/GLSL.std.450.h>

#include "tests/program/cause/probe.hpp"

using namespace tandem::program;
using namespace tandem::program::testing;

namespace {

using Binary = std::function<std::uint32_t(std::uint32_t, std::uint32_t)>;

/// b is wrong by one bit, then a is, then both are.
void check_exact(const Probe& probe, const std::vector<Words>& operands, const Words& right, Random& random) {
  Words wrong = right;
  const std::size_t word = random.word() % wrong.size();
  wrong[word] ^= 1u << random.word() % 32;
  Words other = right;
  other[word] = wrong[word] + 1 != right[word] ? wrong[word] + 1 : wrong[word] + 2;
  CHECK(blames(probe(operands, right, wrong), WrongDevice::b));
  CHECK(blames(probe(operands, wrong, right), WrongDevice::a));
  CHECK(blames(probe(operands, wrong, other), WrongDevice::both));
  const Judgement judgement = probe(operands, right, wrong);
  REQUIRE(judgement.expected);
  CHECK(judgement.expected->words == right);
}

void check_binary(const Probe& probe, const Binary& oracle, std::uint32_t mask = ~0u) {
  Random random;
  for (int i = 0; i < 40; ++i) {
    // Small numbers half of the time: they are equal, divide, and shift more often.
    const std::uint32_t limit = i % 2 == 0 ? ~0u : 15u;
    const std::uint32_t x = random.word() & limit, y = (random.word() & limit & mask) | (mask != ~0u ? 1u : 0u);
    check_exact(probe, {{x}, {y}}, {oracle(x, y)}, random);
  }
}

Probe words(const char* expression, spv::Op op, std::uint32_t glsl = 0) {
  return {"uint x; uint y; uint z; uint w;", "uint", expression, op, glsl};
}

Probe numbers(const char* expression, spv::Op op, std::uint32_t glsl = 0) {
  return {"int x; int y; int z; int w;", "int", expression, op, glsl};
}

std::int32_t number(std::uint32_t word) { return static_cast<std::int32_t>(word); }
std::uint32_t word(std::int64_t number) { return static_cast<std::uint32_t>(number); }

}  // namespace

TEST_CASE("Arithmetic of integers is exact") {
  check_binary(words("x + y", spv::OpIAdd), [](auto x, auto y) { return x + y; });
  check_binary(words("x - y", spv::OpISub), [](auto x, auto y) { return x - y; });
  check_binary(words("x * y", spv::OpIMul), [](auto x, auto y) { return x * y; });
  check_binary(words("x & y", spv::OpBitwiseAnd), [](auto x, auto y) { return x & y; });
  check_binary(words("x | y", spv::OpBitwiseOr), [](auto x, auto y) { return x | y; });
  check_binary(words("x ^ y", spv::OpBitwiseXor), [](auto x, auto y) { return x ^ y; });
  const Probe quotient = words("x / y", spv::OpUDiv), signed_quotient = numbers("x / y", spv::OpSDiv);
  check_binary(
      quotient, [](auto x, auto y) { return x / y; }, 0xffff);
  check_binary(
      words("x % y", spv::OpUMod), [](auto x, auto y) { return x % y; }, 0xffff);
  check_binary(
      signed_quotient, [](auto x, auto y) { return word(number(x) / number(y)); }, 0xffff);
  CHECK(is_undefined(quotient({{7}, {0}}, {0}, {~0u})));
  CHECK(is_undefined(signed_quotient({{0x80000000u}, {~0u}}, {0}, {~0u})));
  CHECK(is_undefined(signed_quotient({{7}, {0}}, {0}, {~0u})));
  CHECK(blames(signed_quotient({{word(-7)}, {2}}, {word(-3)}, {word(-4)}), WrongDevice::b));
  const Probe remainder = numbers("x % y", spv::OpSMod);
  CHECK(is_undefined(remainder({{word(-7)}, {3}}, {2}, {word(-1)})));
  CHECK(is_undefined(remainder.with(spv::OpSRem)({{7}, {word(-3)}}, {1}, {word(-2)})));
  CHECK(blames(remainder({{7}, {3}}, {1}, {2}), WrongDevice::b));
}

TEST_CASE("A subtraction with swapped operands is detected") {
  const Probe difference = words("x - y", spv::OpISub);
  CHECK(blames(difference({{9}, {4}}, {5}, {word(-5)}), WrongDevice::b));
}

TEST_CASE("Shifts are exact below the width, and undefined from there on") {
  const Probe left = words("x << y", spv::OpShiftLeftLogical), right = words("x >> y", spv::OpShiftRightLogical);
  const Probe arithmetic = numbers("x >> y", spv::OpShiftRightArithmetic);
  check_binary(
      left, [](auto x, auto y) { return x << y; }, 31);
  check_binary(
      right, [](auto x, auto y) { return x >> y; }, 31);
  check_binary(
      arithmetic, [](auto x, auto y) { return word(number(x) >> y); }, 31);
  CHECK(blames(left({{1}, {5}}, {1u << 5}, {1u << 6}), WrongDevice::b));
  CHECK(is_undefined(left({{1}, {32}}, {1}, {0})));
  CHECK(is_undefined(right({{1}, {~0u}}, {1}, {0})));
  CHECK(is_undefined(arithmetic({{1}, {33}}, {1}, {0})));
  const Probe narrow("uint8_t x; uint8_t y;", "uint8_t", "x << y", spv::OpShiftLeftLogical);
  Judgement judgement = narrow({{0xc1}, {1}}, {0x82}, {0x83});
  CHECK(blames(judgement, WrongDevice::b));
  CHECK(is_undefined(words("x << y", spv::OpShiftLeftLogical)({{1}, {32}}, {1}, {0})));
}

TEST_CASE("Bits are counted, reversed and found") {
  Random random;
  const Probe count = words("bitCount(x)", spv::OpBitCount), reverse = words("bitfieldReverse(x)", spv::OpBitReverse);
  const Probe lowest = words("findLSB(x)", spv::OpExtInst, GLSLstd450FindILsb);
  const Probe highest = words("findMSB(x)", spv::OpExtInst, GLSLstd450FindUMsb);
  const Probe signed_highest = numbers("findMSB(x)", spv::OpExtInst, GLSLstd450FindSMsb);
  const Probe complement = words("~x", spv::OpNot), negation = numbers("-x", spv::OpSNegate);
  for (int i = 0; i < 20; ++i) {
    const std::uint32_t x = random.word() >> random.word() % 32;
    check_exact(count, {{x}}, {word(std::popcount(x))}, random);
    std::uint32_t reversed = 0;
    for (int bit = 0; bit < 32; ++bit) reversed = reversed << 1 | (x >> bit & 1);
    check_exact(reverse, {{x}}, {reversed}, random);
    check_exact(lowest, {{x}}, {x == 0 ? ~0u : word(std::countr_zero(x))}, random);
    check_exact(highest, {{x}}, {x == 0 ? ~0u : word(31 - std::countl_zero(x))}, random);
    const std::uint32_t magnitude = number(x) < 0 ? ~x : x;
    check_exact(signed_highest, {{x}}, {magnitude == 0 ? ~0u : word(31 - std::countl_zero(magnitude))}, random);
    check_exact(complement, {{x}}, {~x}, random);
    check_exact(negation, {{x}}, {0 - x}, random);
  }
}

TEST_CASE("Bit fields are exact inside of the width, and undefined beyond") {
  Random random;
  const Probe insert = words("bitfieldInsert(x, y, int(z), int(w))", spv::OpBitFieldInsert);
  const Probe extract = words("bitfieldExtract(x, int(y), int(z))", spv::OpBitFieldUExtract);
  const Probe signed_extract = numbers("bitfieldExtract(x, y, z)", spv::OpBitFieldSExtract);
  for (int i = 0; i < 40; ++i) {
    const std::uint32_t x = random.word(), y = random.word(), offset = random.word() % 33;
    const std::uint32_t bits = random.word() % (33 - offset);
    std::uint32_t inserted = x, extracted = 0;
    for (std::uint32_t bit = 0; bit < bits; ++bit) {
      inserted = (inserted & ~(1u << (offset + bit))) | (y >> bit & 1) << (offset + bit);
      extracted |= (x >> (offset + bit) & 1) << bit;
    }
    check_exact(insert, {{x}, {y}, {offset}, {bits}}, {inserted}, random);
    check_exact(extract, {{x}, {offset}, {bits}}, {extracted}, random);
    if (bits > 0 && bits < 32 && (extracted >> (bits - 1) & 1) != 0) extracted |= ~0u << bits;
    check_exact(signed_extract, {{x}, {offset}, {bits}}, {extracted}, random);
  }
  CHECK(is_undefined(insert({{1}, {2}, {30}, {3}}, {0}, {1})));
  CHECK(is_undefined(extract({{1}, {33}, {0}}, {0}, {1})));
  CHECK(is_undefined(signed_extract({{1}, {4}, {~0u}}, {0}, {1})));
}

TEST_CASE("Comparisons of integers know the sign") {
  Random random;
  const Probe less("uint x; uint y;", "uint", "uint(x < y)", spv::OpULessThan);
  const Probe signed_less("int x; int y;", "uint", "uint(x < y)", spv::OpSLessThan);
  const Probe equal("int x; int y;", "uint", "uint(x == y)", spv::OpIEqual);
  for (int i = 0; i < 20; ++i) {
    const std::uint32_t x = random.word(), y = i % 3 == 0 ? x : random.word();
    const auto check = [&](const Probe& probe, bool right) {
      CHECK(blames(probe({{x}, {y}}, {right}, {!right}), WrongDevice::b));
      CHECK(blames(probe({{x}, {y}}, {!right}, {right}), WrongDevice::a));
    };
    check(less, x < y);
    check(less.with(spv::OpULessThanEqual), x <= y);
    check(less.with(spv::OpUGreaterThan), x > y);
    check(less.with(spv::OpUGreaterThanEqual), x >= y);
    check(signed_less, number(x) < number(y));
    check(signed_less.with(spv::OpSLessThanEqual), number(x) <= number(y));
    check(signed_less.with(spv::OpSGreaterThan), number(x) > number(y));
    check(signed_less.with(spv::OpSGreaterThanEqual), number(x) >= number(y));
    check(equal, x == y);
    check(equal.with(spv::OpINotEqual), x != y);
  }
}

TEST_CASE("Logical operations are exact") {
  const Probe both("bvec2 x; bvec2 y;", "bool", "all(equal(x, y))", spv::OpLogicalEqual);
  const Probe all("bvec2 x; bvec2 y;", "bool", "all(equal(x, y))", spv::OpAll);
  CHECK(blames(both({{1, 0}, {1, 1}}, {1, 0}, {0, 0}), WrongDevice::b));
  CHECK(blames(both.with(spv::OpLogicalAnd)({{1, 0}, {1, 1}}, {1, 1}, {1, 0}), WrongDevice::a));
  CHECK(blames(both.with(spv::OpLogicalOr)({{1, 0}, {1, 1}}, {1, 1}, {1, 0}), WrongDevice::b));
  CHECK(blames(both.with(spv::OpLogicalNotEqual)({{1, 0}, {1, 1}}, {0, 1}, {1, 0}), WrongDevice::b));
  CHECK(blames(all({{1, 0}}, {0}, {1}), WrongDevice::b));
  CHECK(blames(all.with(spv::OpAny)({{1, 0}}, {0}, {1}), WrongDevice::a));
}

TEST_CASE("Carries, high halves and 64 bits are exact") {
  Random random;
  const auto pair = [](const char* call, const char* type, spv::Op op) {
    const std::string t = type;
    return Probe(t + " x; " + t + " y; " + t + " high; " + t + " low;", t, call, op);
  };
  const Probe carry = pair("uaddCarry(x, y, high)", "uint", spv::OpIAddCarry);
  const Probe borrow = pair("usubBorrow(x, y, high)", "uint", spv::OpISubBorrow);
  const Probe product("uint64_t x; uint64_t y;", "uint64_t", "x * y", spv::OpIMul);
  for (int i = 0; i < 20; ++i) {
    const std::uint32_t x = random.word(), y = random.word();
    const std::uint64_t sum = std::uint64_t{x} + y, wide_product = std::uint64_t{x} * y;
    check_exact(carry, {{x}, {y}}, {word(static_cast<std::int64_t>(sum)), static_cast<std::uint32_t>(sum >> 32)},
                random);
    check_exact(borrow, {{x}, {y}}, {x - y, x < y}, random);
    check_exact(carry.with(spv::OpUMulExtended), {{x}, {y}},
                {static_cast<std::uint32_t>(wide_product), static_cast<std::uint32_t>(wide_product >> 32)}, random);
    const std::int64_t signed_product = std::int64_t{number(x)} * number(y);
    check_exact(carry.with(spv::OpSMulExtended), {{x}, {y}}, {word(signed_product), word(signed_product >> 32)},
                random);
    const std::uint64_t p = random.long_word(), q = random.long_word();
    check_exact(product, {wide(p), wide(q)}, wide(p * q), random);
  }
}

TEST_CASE("Minimum, maximum, clamp, abs and sign of integers") {
  Random random;
  const Probe clamp = numbers("clamp(x, y, z)", spv::OpExtInst, GLSLstd450SClamp);
  const Probe unsigned_clamp = words("clamp(x, y, z)", spv::OpExtInst, GLSLstd450UClamp);
  check_binary(numbers("min(x, y)", spv::OpExtInst, GLSLstd450SMin),
               [](auto x, auto y) { return word(std::min(number(x), number(y))); });
  check_binary(numbers("max(x, y)", spv::OpExtInst, GLSLstd450SMax),
               [](auto x, auto y) { return word(std::max(number(x), number(y))); });
  check_binary(words("min(x, y)", spv::OpExtInst, GLSLstd450UMin), [](auto x, auto y) { return std::min(x, y); });
  check_binary(words("max(x, y)", spv::OpExtInst, GLSLstd450UMax), [](auto x, auto y) { return std::max(x, y); });
  check_exact(clamp, {{word(-5)}, {word(-3)}, {4}}, {word(-3)}, random);
  check_exact(unsigned_clamp, {{word(-5)}, {3}, {4}}, {4}, random);
  CHECK(is_undefined(clamp({{0}, {4}, {3}}, {3}, {4})));
  check_exact(numbers("abs(x)", spv::OpExtInst, GLSLstd450SAbs), {{word(-5)}}, {5}, random);
  check_exact(numbers("sign(x)", spv::OpExtInst, GLSLstd450SSign), {{word(-5)}}, {word(-1)}, random);
}

TEST_CASE("Integer dot products saturate only where they say so") {
  const Probe sum("ivec2 x; ivec2 y;", "ivec2", "x + y", spv::OpIAdd);
  const Probe scalar("int x; int y;", "int", "x + y", spv::OpIAdd);
  const Probe packed = scalar.with(spv::OpSDotKHR);
  // (1, -2, 3, -128) . (4, 5, 6, 2)
  CHECK(blames(packed({{0x8003fe01u}, {0x02060504u}}, {word(4 - 10 + 18 - 256)}, {0}), WrongDevice::b));
  CHECK(blames(scalar.with(spv::OpUDotKHR)({{0x8003fe01u}, {0x02060504u}}, {4 + 254 * 5 + 18 + 256}, {0}),
               WrongDevice::b));
  CHECK(blames(scalar.with(spv::OpSUDotKHR)({{0x000000ffu}, {0x000000ffu}}, {word(-255)}, {0}), WrongDevice::b));
}
