// GLSL's built-in functions. What IEEE 754 rounds exactly is compared to the bit; the C library's functions with the
// same function called here.

#include <cmath>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "rhi_cpu/kernel/packing.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::test::evaluate;
using tandem::test::Kernel;
using tandem::test::resource;
using Floats = std::vector<float>;

constexpr float x = 2.5f;
constexpr float n = 0.7f;

/// The statements may use x = 2.5 and n = 0.7, which no compiler can fold. Not with an optimised module: spirv-opt may
/// reassociate what is not `precise`.
Floats floats(std::size_t count, const std::string& statements) {
  Floats result(count), inputs = {x, n};
  Kernel(
      "layout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer Result { float result[]; };\n"
      "layout(std430, binding = 1) readonly buffer In { float inputs[]; };\n"
      "void main() { float x = inputs[0], n = inputs[1];\n" +
      statements + "}\n")
      .run({resource(result), resource(inputs)});
  return result;
}

void check_equal(const Floats& result, const Floats& expected) {
  REQUIRE(result.size() == expected.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    CAPTURE(i);
    CHECK(std::bit_cast<std::uint32_t>(result[i]) == std::bit_cast<std::uint32_t>(expected[i]));
  }
}

TEST_CASE("rounding functions, halves and signs of zero included") {
  check_equal(floats(19, R"(
    result[0] = floor(x); result[1] = floor(-x); result[2] = ceil(x); result[3] = ceil(-x); result[4] = trunc(-x);
    result[5] = round(x); result[6] = roundEven(x + 1.0); result[7] = roundEven(-x); result[8] = fract(-x);
    result[9] = ceil(-0.2 * x); result[10] = trunc(-0.2 * x); result[11] = floor(-0.2 * x); result[12] = floor(x * 1e10);
    result[13] = ceil(x - 2.0); result[14] = sign(-x); result[15] = abs(-x); result[16] = mod(-x, 2.0);
    result[17] = floor(vec3(1.5, x, -x)).z; result[18] = step(x, 2.0) + step(2.0, x) * 2.0;
  )"),
              {2, -3, 3, -2, -2, 2, 4, -2, 0.5f, -0.0f, -0.0f, -1, 2.5e10f, 1, -1, 2.5f, 1.5f, -3, 2});
}

TEST_CASE("common functions in Mesa's order of operations") {
  const float t = (n - 0.25f) / (1.5f - 0.25f);
  check_equal(floats(10, R"(
    result[0] = mix(x, 7.0, n); result[1] = smoothstep(0.25, 1.5, n); result[2] = fma(x, n, 0.1);
    result[3] = clamp(x, 0.0, 2.0); result[4] = inversesqrt(x); result[5] = sqrt(n); result[6] = radians(x);
    result[7] = degrees(n); result[8] = min(x, n) + max(x, n) * 10.0; result[9] = pow(x, n);
  )"),
              {x * (1.0f - n) + 7.0f * n, t * (t * (3.0f - 2.0f * t)), x * n + 0.1f, 2.0f, 1.0f / std::sqrt(x),
               std::sqrt(n), x * 0.017453292519943295f, n * 57.29577951308232f, n + x * 10.0f, std::pow(x, n)});
}

TEST_CASE("transcendental functions are the C library's") {
  // Folded by the compiler they would be rounded correctly, which the library does not promise.
  const volatile float run_time_x = 2.5f, run_time_n = 0.7f;
  const float x = run_time_x, n = run_time_n;
  check_equal(floats(17, R"(
    result[0] = sin(x); result[1] = cos(x); result[2] = tan(x); result[3] = asin(n); result[4] = acos(n);
    result[5] = atan(x); result[6] = atan(x, n); result[7] = sinh(x); result[8] = cosh(x); result[9] = tanh(n);
    result[10] = asinh(x); result[11] = acosh(x); result[12] = atanh(n); result[13] = exp(x); result[14] = log(x);
    result[15] = exp2(n); result[16] = log2(x);
  )"),
              {std::sin(x), std::cos(x), std::tan(x), std::asin(n), std::acos(n), std::atan(x), std::atan2(x, n),
               std::sinh(x), std::cosh(x), std::tanh(n), std::asinh(x), std::acosh(x), std::atanh(n), std::exp(x),
               std::log(x), std::exp2(n), std::log2(x)});
}

TEST_CASE("geometric functions in Mesa's order of operations") {
  const float v[3] = {x, n, 1.25f}, w[3] = {0.5f, -x, n};
  const float vw = (v[0] * w[0] + v[1] * w[1]) + v[2] * w[2];
  const float length = std::sqrt((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
  const float k = 1.0f - 0.4f * (0.4f * (1.0f - vw * vw));
  Floats expected = {vw, length, v[1] * w[2] - w[1] * v[2], v[2] * w[0] - w[2] * v[0], v[0] * w[1] - w[0] * v[1]};
  for (const float c : v) expected.push_back(c / length);
  for (int i = 0; i < 3; ++i) expected.push_back(v[i] - w[i] * (2.0f * vw));
  for (int i = 0; i < 3; ++i) expected.push_back(k < 0 ? 0.0f : v[i] * 0.4f - w[i] * (0.4f * vw + std::sqrt(k)));
  const float d[3] = {v[0] - w[0], v[1] - w[1], v[2] - w[2]};
  expected.push_back(std::sqrt((d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]));
  expected.push_back(vw < 0 ? v[0] : -v[0]);
  check_equal(floats(16, R"(
    vec3 v = vec3(x, n, 1.25), w = vec3(0.5, -x, n), c = cross(v, w), u = normalize(v), r = reflect(v, w), t = refract(v, w, 0.4);
    result[0] = dot(v, w); result[1] = length(v);
    for (int i = 0; i < 3; ++i) { result[2 + i] = c[i]; result[5 + i] = u[i]; result[8 + i] = r[i]; result[11 + i] = t[i]; }
    result[14] = distance(v, w); result[15] = faceforward(v, w, v).x;
  )"),
              expected);
}

TEST_CASE("matrices are column vectors, and products sum from the last column") {
  check_equal(
      floats(12, R"(
    mat4x3 m = mat4x3(1.1, 2.2, 3.3, x, n, 0.3, 7.0, 8.0, 9.0, 0.1, 0.2, 0.7);
    vec4 v = vec4(x, n, 0.1, 3.0);
    vec3 p = m * v;
    result[0] = p.x; result[1] = p.y; result[2] = p.z;
    vec4 q = vec3(n, x, 0.3) * m;
    result[3] = q.y; result[4] = transpose(m)[2][1]; result[5] = outerProduct(vec3(1, 2, 3), vec2(x, n))[1][2];
    mat2 a = mat2(1, 2, 3, x), b = mat2(n, 5, 6, 7);
    mat2 ab = a * b;
    result[6] = ab[0][1]; result[7] = ab[1][0]; result[8] = determinant(a); result[9] = (a * 2.0 + b)[1][1];
    result[10] = matrixCompMult(a, b)[0][1]; result[11] = inverse(mat2(2, 0, 0, 4))[1][1];
  )"),
      {((0.1f * 3.0f + 7.0f * 0.1f) * 1.0f + x * n) + 1.1f * x, ((0.2f * 3.0f + 8.0f * 0.1f) + n * n) + 2.2f * x,
       ((0.7f * 3.0f + 9.0f * 0.1f) + 0.3f * n) + 3.3f * x, (n * x + x * n) + 0.3f * 0.3f, 0.3f, 3.0f * n,
       x * 5.0f + 2.0f * n, 3.0f * 7.0f + 1.0f * 6.0f, 1.0f * x - 3.0f * 2.0f, x * 2.0f + 7.0f, 10.0f, 0.25f});
}

TEST_CASE("splitting and joining of floats") {
  check_equal(floats(6, R"(
    float whole; int exponent;
    result[0] = modf(-x, whole); result[1] = whole;
    result[2] = frexp(x, exponent); result[3] = float(exponent);
    result[4] = ldexp(n, 3); result[5] = uintBitsToFloat(floatBitsToUint(x) ^ 0x80000000u);
  )"),
              {-0.5f, -2.0f, 0.625f, 2.0f, n * 8.0f, -x});
}

TEST_CASE("packing functions") {
  const std::vector<std::uint32_t> result = evaluate<std::uint32_t>("uint", 10, R"(
    float x = float(result.length()) / 10.0;
    result[0] = packUnorm4x8(vec4(x, 0.5, -1.0, 0.2)); result[1] = packSnorm4x8(vec4(x, -0.5, -2.0, 0.2));
    result[2] = packUnorm2x16(vec2(x, 0.25)); result[3] = packSnorm2x16(vec2(-x, 0.25));
    result[4] = packHalf2x16(vec2(x, -65504.0)); result[5] = packHalf2x16(vec2(1e-7, 70000.0) * x);
    result[6] = floatBitsToUint(unpackHalf2x16(0x3555fc00u).y); result[7] = floatBitsToUint(unpackUnorm4x8(0x80ff0010u).w);
    result[8] = floatBitsToUint(unpackSnorm4x8(0x80ff0010u).w); result[9] = floatBitsToUint(unpackSnorm2x16(0x8001ffffu).x);
  )");
  const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f); };
  // 0.5 * 255 = 127.5 rounds to even, 128; -0.5 * 127 = -63.5 to -64.
  CHECK(result[0] == 0x330080ffu);
  CHECK(result[1] == 0x1981c07fu);
  CHECK(result[2] == 0x4000ffffu);
  CHECK(result[3] == 0x20008001u);
  CHECK(result[4] == 0xfbff3c00u);
  CHECK(result[5] == 0x7c000002u);
  CHECK(result[6] == bits(0.333251953125f));
  CHECK(result[7] == bits(128.0f / 255.0f));
  CHECK(result[8] == bits(-1.0f));
  CHECK(result[9] == bits(-1.0f / 32767.0f));
}

TEST_CASE("every half is the nearest to the float it came from") {
  using tandem::kernel::float_to_half;
  using tandem::kernel::half_to_float;
  for (std::uint32_t half = 0; half < 0x7c00u; ++half) {
    const float exact = half_to_float(half);
    REQUIRE(float_to_half(exact) == half);
    const float next = half_to_float(half + 1);
    if (half + 1 == 0x7c00u) continue;
    const float middle = exact + (next - exact) / 2;  // representable: a float has 13 more bits
    REQUIRE(float_to_half(middle) == half + (half & 1));
    REQUIRE(float_to_half(std::nextafter(middle, 0.0f)) == half);
    REQUIRE(float_to_half(std::nextafter(middle, 1e30f)) == half + 1);
  }
}

}  // namespace
