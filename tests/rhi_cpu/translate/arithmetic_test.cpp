// Integers, conversions, bits and relations. Expected values are computed with plain C++ on the other side, or are what
// GLSL and SPIR-V say; cases that they leave undefined test what kernel/components.hpp promises.

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

/// clang links no sanitizer runtime into a shared library, so there undefined behaviour is a trap instead of a message.
#ifdef __clang__
constexpr const char* undefined_behavior_ends = "-fsanitize-trap=undefined";
#else
constexpr const char* undefined_behavior_ends = "-fno-sanitize-recover=all";
#endif

using tandem::test::evaluate;
using tandem::test::Kernel;
using tandem::test::KernelOptions;
using tandem::test::resource;

constexpr std::int32_t smallest = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t largest = std::numeric_limits<std::int32_t>::max();

/// Values that the compilers on either side cannot fold, because they come from a buffer.
const char* const inputs =
    "layout(std430, binding = 1) readonly buffer In { int i[]; };\n"
    "layout(std430, binding = 2) readonly buffer Fn { float f[]; };\n"
    "layout(std430, binding = 0) buffer Result { int result[]; };\nlayout(local_size_x = 1) in;\n";

std::vector<std::int32_t> run(const std::string& statements, std::vector<std::int32_t> i, std::vector<float> f,
                              std::size_t count) {
  // Undefined behaviour in the translated code ends the test.
  const KernelOptions options = {.specialization = {},
                                 .more_options = {"-fsanitize=undefined", undefined_behavior_ends}};
  std::vector<std::int32_t> result(count, 12345);
  Kernel(inputs + ("void main() {\n" + statements + "}\n"), options).run({resource(result), resource(i), resource(f)});
  return result;
}

TEST_CASE("integer arithmetic has no undefined cases") {
  const std::vector<std::int32_t> result = run(R"(
    int lowest = i[0], highest = i[1], zero = i[2], minus_one = i[3], seven = i[4], minus_seven = i[5], three = i[6];
    result[0] = highest + 1;
    result[1] = lowest - 1;
    result[2] = highest * 3;
    result[3] = -lowest;
    result[4] = lowest / minus_one;
    result[5] = seven / zero;
    result[6] = int(uint(seven) / uint(zero));
    result[7] = lowest % minus_one;
    result[8] = seven % zero;
    result[9] = minus_seven / three;
    result[10] = minus_seven % three;
    result[11] = int(uint(minus_seven) / 2u);
    result[12] = abs(lowest);
    result[13] = (ivec3(lowest, seven, highest) * ivec3(2, minus_one, 2)).z;
    result[14] = int(uint(minus_seven) % 10u);
  )",
                                               {smallest, largest, 0, -1, 7, -7, 3}, {0}, 15);
  CHECK(result[0] == smallest);
  CHECK(result[1] == largest);
  CHECK(result[2] == static_cast<std::int32_t>(3u * static_cast<std::uint32_t>(largest)));
  CHECK(result[3] == smallest);
  CHECK(result[4] == smallest);
  CHECK(result[5] == 0);
  CHECK(result[6] == -1);
  CHECK(result[7] == 0);
  CHECK(result[8] == -1);
  CHECK(result[9] == -2);
  // GLSL leaves % of negative operands undefined; glslang writes OpSMod, whose result has the divisor's sign.
  CHECK(result[10] == 2);
  CHECK(result[11] == static_cast<std::int32_t>(static_cast<std::uint32_t>(-7) / 2));
  CHECK(result[12] == smallest);
  CHECK(result[13] == -2);
  CHECK(result[14] == static_cast<std::int32_t>(static_cast<std::uint32_t>(-7) % 10));
}

TEST_CASE("shifts take their count modulo the width and keep or drop the sign by type") {
  const std::vector<std::int32_t> result = run(R"(
    result[0] = i[0] << i[1];
    result[1] = i[0] >> i[1];
    result[2] = int(uint(i[0]) >> uint(i[1]));
    result[3] = i[0] << i[2];
    result[4] = i[0] >> i[2];
    result[5] = (ivec2(i[0]) << uvec2(1, 31)).x;
    result[6] = int((uvec2(i[0]) >> ivec2(1, 31)).y);
  )",
                                               {-5, 2, 33}, {0}, 7);
  CHECK(result == std::vector<std::int32_t>{-20, -2, 0x3ffffffe, -10, -3, -10, 1});
}

TEST_CASE("conversions from float are defined for every value") {
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<std::int32_t> result =
      run(R"(
    for (int k = 0; k < 8; ++k) {
      result[2 * k] = int(f[k]);
      result[2 * k + 1] = int(uint(f[k]));
    }
    result[16] = floatBitsToInt(float(i[0]));
    result[17] = floatBitsToInt(float(uint(i[0])));
    result[18] = int(bool(i[0])) + int(bool(f[7]));
  )",
          {-3}, {-2.9f, 2.9f, 3e9f, -3e9f, 1e20f, infinity, std::nanf(""), 0.0f}, 19);
  const auto bits = [](float x) { return std::bit_cast<std::int32_t>(x); };
  CHECK(result == std::vector<std::int32_t>{-2, 0, 2, 2, smallest, static_cast<std::int32_t>(3000000000u), smallest, 0,
                                            smallest, -1, smallest, -1, smallest, 0, 0, 0, bits(-3.0f),
                                            bits(4294967293.0f), 1});
}

TEST_CASE("bit functions") {
  const std::vector<std::int32_t> result = run(R"(
    result[0] = bitCount(i[0]);
    result[1] = findLSB(i[0]);
    result[2] = findMSB(i[0]);
    result[3] = findMSB(uint(i[0]));
    result[4] = findMSB(0) + findLSB(0) + findMSB(-1);
    result[5] = bitfieldExtract(i[1], 4, 8);
    result[6] = int(bitfieldExtract(uint(i[1]), 4, 8));
    result[7] = bitfieldExtract(i[1], 0, 32);
    result[8] = bitfieldExtract(i[1], 3, 0);
    result[9] = bitfieldInsert(i[1], i[0], 8, 12);
    result[10] = bitfieldReverse(i[1]);
    uint carry, borrow, high, low;
    result[11] = int(uaddCarry(uint(i[0]), uint(i[1]), carry));
    result[12] = int(carry);
    result[13] = int(usubBorrow(1u, uint(i[1]), borrow));
    result[14] = int(borrow);
    umulExtended(uint(i[0]), uint(i[1]), high, low);
    result[15] = int(high);
    result[16] = int(low);
    int signed_high, signed_low;
    imulExtended(i[0], i[1], signed_high, signed_low);
    result[17] = signed_high;
    result[18] = ~i[1] ^ (i[0] & 255) | 1;
    result[19] = bitCount(ivec2(i[0], i[1])).y;
  )",
                                               {-256, 0x12345fa7}, {0}, 20);
  const std::int64_t product = std::int64_t{-256} * 0x12345fa7;
  const std::uint64_t unsigned_product = std::uint64_t{0xffffff00u} * 0x12345fa7u;
  const std::vector<std::int32_t> expected = {24,
                                              8,
                                              7,
                                              31,
                                              -3,
                                              -6,
                                              0xfa,
                                              0x12345fa7,
                                              0,
                                              0x123f00a7,
                                              static_cast<std::int32_t>(0xe5fa2c48u),
                                              0x12345ea7,
                                              1,
                                              static_cast<std::int32_t>(1u - 0x12345fa7u),
                                              1,
                                              static_cast<std::int32_t>(unsigned_product >> 32),
                                              static_cast<std::int32_t>(unsigned_product),
                                              static_cast<std::int32_t>(product >> 32),
                                              (~0x12345fa7 ^ 0) | 1,
                                              16};
  for (std::size_t k = 0; k < expected.size(); ++k) {
    CAPTURE(k);
    CHECK(result[k] == expected[k]);
  }
}

TEST_CASE("relations know signs and NaN") {
  const std::vector<std::int32_t> result =
      run(R"(
    float nan = f[0], one = f[1];
    result[0] = int(nan == nan) + 2 * int(nan != nan) + 4 * int(nan < one) + 8 * int(nan >= one) + 16 * int(!(nan < one));
    result[1] = int(i[0] < i[1]) + 2 * int(uint(i[0]) < uint(i[1]));
    result[2] = int(any(lessThan(vec3(1, 2, 3), vec3(one)))) + 2 * int(all(greaterThanEqual(vec3(1, 2, 3), vec3(one))));
    result[3] = int(isnan(nan)) + 2 * int(isinf(f[2])) + 4 * int(isinf(one));
    bvec3 b = not(equal(ivec3(1, i[0], 3), ivec3(1, 2, i[1])));
    result[4] = int(b.x) + 2 * int(b.y) + 4 * int(b.z);
    result[5] = int(mix(vec2(1, 2), vec2(3, 4), bvec2(one > 0.0, one < 0.0)).x);
    result[6] = one > 0.0 ? i[0] : i[1];
    result[7] = int(min(nan, one)) + int(max(nan, one)) + int(clamp(f[2], 0.0, 5.0));
  )",
          {-1, 3}, {std::nanf(""), 1.0f, -std::numeric_limits<float>::infinity()}, 8);
  CHECK(result == std::vector<std::int32_t>{2 + 16, 1, 2, 1 + 2, 2, 3, -1, 2});
}

TEST_CASE("a negated zero has the other sign in vectors of every length") {
  const std::vector<std::int32_t> result = run(R"(
    vec4 zeros = vec4(f[0], f[1], f[0], f[i[0]]);
    ivec2 two = floatBitsToInt(-zeros.xy);
    ivec3 three = floatBitsToInt(-zeros.xyz);
    ivec4 four = floatBitsToInt(-zeros), turned = floatBitsToInt(faceforward(zeros, vec4(1), vec4(1)));
    result[0] = int(two.x < 0) + 2 * int(two.y < 0);
    result[1] = int(three.x < 0) + 2 * int(three.y < 0) + 4 * int(three.z < 0);
    result[2] = int(four.x < 0) + 2 * int(four.y < 0) + 4 * int(four.z < 0) + 8 * int(four.w < 0);
    result[3] = int(turned.x < 0) + 2 * int(turned.y < 0) + 4 * int(turned.z < 0) + 8 * int(turned.w < 0);
  )",
                                               {1}, {0.0f, -0.0f}, 4);
  CHECK(result == std::vector<std::int32_t>{1, 5, 5, 5});
}

TEST_CASE("64-bit and small integers and doubles") {
  const std::vector<std::int64_t> integers =
      evaluate<std::int64_t>("int64_t", 5, R"(
    int64_t big = int64_t(result.length()) * 4000000000l;
    result[0] = big * big;
    result[1] = big >> 3;
    result[2] = int64_t(uint64_t(big) / 7ul);
    result[3] = big / 0l;
    int8_t small = int8_t(result.length() + 122);
    result[4] = int64_t(int8_t(small + small));
  )",
                             "#extension GL_EXT_shader_explicit_arithmetic_types : require\n");
  CHECK(integers[0] == static_cast<std::int64_t>(20000000000ull * 20000000000ull));
  CHECK(integers[1] == 2500000000);
  CHECK(integers[2] == 20000000000 / 7);
  CHECK(integers[3] == 0);
  CHECK(integers[4] == -2);

  const std::vector<double> doubles = evaluate<double>("double", 3, R"(
    double third = 1.0lf / double(result.length());
    result[0] = third;
    result[1] = sqrt(third);
    result[2] = dot(dvec3(1, 2, 3), dvec3(third));
  )");
  CHECK(doubles[0] == 1.0 / 3.0);
  CHECK(doubles[1] == std::sqrt(1.0 / 3.0));
  CHECK(doubles[2] == (1.0 / 3.0 + 2.0 * (1.0 / 3.0)) + 3.0 * (1.0 / 3.0));
}

}  // namespace
