// 16-bit floats in memory, in types and through conversions.

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/rhi_cpu/translate/assembly.hpp"
#include "tests/rhi_cpu/translate/half_reference.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::test::evaluate;
using tandem::test::half_value;
using tandem::test::is_half_nan;
using tandem::test::Kernel;
using tandem::test::nearest_half;
using tandem::test::resource;

const std::string extensions =
    "#extension GL_EXT_shader_explicit_arithmetic_types : require\n"
    "#extension GL_EXT_shader_16bit_storage : require\n"
    "#extension GL_EXT_scalar_block_layout : require\n"
    "#extension GL_EXT_spirv_intrinsics : enable\n";

std::vector<std::uint16_t> halves(std::initializer_list<double> values) {
  std::vector<std::uint16_t> bits;
  for (const double value : values) bits.push_back(nearest_half(value));
  return bits;
}

template <typename T>
std::int64_t truncated(double x) {
  using Limits = std::numeric_limits<T>;
  const double whole = std::trunc(x);
  if (std::is_signed_v<T>)
    return whole >= double(Limits::min()) && whole < -double(Limits::min()) ? std::int64_t(whole)
                                                                            : std::int64_t(Limits::min());
  if (!(whole > 0)) return 0;
  return whole < std::ldexp(1.0, Limits::digits) ? std::int64_t(whole) : std::int64_t(Limits::max());
}

TEST_CASE("every half becomes integers of every width, and a float, a double") {
  std::vector<std::uint16_t> values(65536);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint16_t>(i);
  constexpr std::size_t columns = 10;
  std::vector<std::int64_t> results(columns * values.size());
  Kernel(extensions + R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer In { float16_t values[]; };
layout(std430, binding = 1) buffer Out { int64_t results[]; };
void main() {
  uint i = gl_GlobalInvocationID.x, first = 10 * i;
  float16_t x = values[i];
  results[first] = int64_t(int8_t(x));
  results[first + 1] = int64_t(int16_t(x));
  results[first + 2] = int64_t(int(x));
  results[first + 3] = int64_t(x);
  results[first + 4] = int64_t(uint8_t(x));
  results[first + 5] = int64_t(uint16_t(x));
  results[first + 6] = int64_t(uint(x));
  results[first + 7] = int64_t(uint64_t(x));
  results[first + 8] = int64_t(floatBitsToInt(float(x)));
  results[first + 9] = doubleBitsToInt64(double(x));
})",
         {})
      .run({resource(values), resource(results)}, {1024});
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = half_value(values[i]);
    std::vector<std::int64_t> expected = {
        truncated<std::int8_t>(x),     truncated<std::int16_t>(x),  truncated<std::int32_t>(x),
        truncated<std::int64_t>(x),    truncated<std::uint8_t>(x),  truncated<std::uint16_t>(x),
        truncated<std::uint32_t>(x),   truncated<std::uint64_t>(x), std::bit_cast<std::int32_t>(static_cast<float>(x)),
        std::bit_cast<std::int64_t>(x)};
    if (is_half_nan(values[i])) {
      CHECK(std::isnan(std::bit_cast<double>(results[columns * i + 9])));
      expected[8] = results[columns * i + 8];  // Which NaN is not said.
      expected[9] = results[columns * i + 9];
    }
    for (std::size_t k = 0; k < columns; ++k) {
      if (results[columns * i + k] == expected[k]) continue;
      if (wrong++ == 0) MESSAGE("conversion ", k, " of ", x, " is ", results[columns * i + k], ", not ", expected[k]);
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("integers, floats and doubles become the nearest half") {
  const std::vector<std::int32_t> integers = {0,     1,     -1,    2047,  2049,   2050,    2051,   -2051, 4098,
                                              65504, 65519, 65520, 65535, -65536, 1 << 30, 100000, 8193,  -32768};
  std::vector<std::int32_t> values = integers;
  std::vector<std::uint16_t> results(5 * integers.size());
  // Doubles that a conversion by way of float would round twice, to the other side of a tie.
  std::vector<double> doubles = {1.0 + std::ldexp(1.0, -11) + std::ldexp(1.0, -40),
                                 1.0 + 3 * std::ldexp(1.0, -11) - std::ldexp(1.0, -40),
                                 -1.0 - std::ldexp(1.0, -11) - std::ldexp(1.0, -40),
                                 std::ldexp(1.0, -25) + std::ldexp(1.0, -60),
                                 std::ldexp(1.0, -25),
                                 65520.0 - std::ldexp(1.0, -20),
                                 std::ldexp(1.0, 300),
                                 std::ldexp(-1.0, -300)};
  Kernel(extensions + R"(
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer In { int values[]; };
layout(std430, binding = 1) buffer Out { float16_t results[]; };
layout(std430, binding = 2) buffer Doubles { double doubles[]; };
layout(std430, binding = 3) buffer OfDoubles { float16_t of_doubles[]; };
void main() {
  for (int i = 0; i < values.length(); ++i) {
    results[5 * i] = float16_t(values[i]);
    results[5 * i + 1] = float16_t(uint(values[i]));
    results[5 * i + 2] = float16_t(int16_t(values[i]));
    results[5 * i + 3] = float16_t(uint64_t(int64_t(values[i])));
    results[5 * i + 4] = f16vec2(vec2(values[i])).y;
  }
  for (int i = 0; i < doubles.length(); ++i) of_doubles[i] = float16_t(doubles[i]);
})",
         {})
      .run({resource(values), resource(results), resource(doubles), resource(results)});
  for (std::size_t i = 0; i < doubles.size(); ++i) CHECK(results[i] == nearest_half(doubles[i]));
  Kernel(extensions + R"(
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer In { int values[]; };
layout(std430, binding = 1) buffer Out { float16_t results[]; };
void main() {
  for (int i = 0; i < values.length(); ++i) {
    results[5 * i] = float16_t(values[i]);
    results[5 * i + 1] = float16_t(uint(values[i]));
    results[5 * i + 2] = float16_t(int16_t(values[i]));
    results[5 * i + 3] = float16_t(uint64_t(int64_t(values[i])));
    results[5 * i + 4] = f16vec2(vec2(values[i])).y;
  }
})",
         {})
      .run({resource(values), resource(results)});
  for (std::size_t i = 0; i < integers.size(); ++i) {
    CAPTURE(integers[i]);
    CHECK(results[5 * i] == nearest_half(integers[i]));
    CHECK(results[5 * i + 1] == nearest_half(static_cast<std::uint32_t>(integers[i])));
    CHECK(results[5 * i + 2] == nearest_half(static_cast<std::int16_t>(integers[i])));
    CHECK(results[5 * i + 3] == nearest_half(static_cast<double>(static_cast<std::uint64_t>(integers[i]))));
    CHECK(results[5 * i + 4] == nearest_half(integers[i]));
  }
}

TEST_CASE("halves lie in buffers, push constants, structs, arrays and matrices") {
  // Offsets in halves: std430 aligns a vector of three to four.
  std::vector<std::uint16_t> in = halves({1, 2, 0, 0, 3, 4, 5, 0, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19});
  std::vector<std::uint16_t> out(24), scalars = halves({1, 2, 3, 4, 5, 6, 7, 8, 9});
  std::vector<std::uint16_t> pushed = halves({0.5, 0, 0.25, 0.125});
  const std::vector<std::uint16_t> specialized = halves({3});
  const tandem::test::KernelOptions options = {.specialization = {{.id = 3, .value = specialized[0]}},
                                               .more_options = {}};
  Kernel(extensions + R"(
layout(local_size_x = 1) in;
spirv_execution_mode(extensions = ["SPV_KHR_float_controls"], capabilities = [4467], 4462, 16);  // RoundingModeRTE
layout(constant_id = 3) const float16_t factor = float16_t(7);
struct Pair { float16_t a; f16vec2 b; };
layout(std430, binding = 0) readonly buffer In {
  float16_t one, two; f16vec3 three; f16vec2 columns[2]; layout(row_major) f16mat2x3 rows; float16_t more[];
} data;
layout(std430, binding = 1) writeonly buffer Out { float16_t results[]; };
layout(scalar, binding = 2) buffer Scalars { Pair pairs[3]; };
layout(push_constant) uniform Pushed { float16_t p; f16vec2 q; } pushed;
const float16_t table[3] = float16_t[3](float16_t(0.1), float16_t(-65504), float16_t(6e-8));
f16vec2 twice(in f16vec2 v, inout float16_t s, out Pair p) { s *= float16_t(2); p = Pair(s, v); return v + v; }
void main() {
  results[0] = data.one + data.two;
  results[1] = data.three.x; results[2] = data.three.y; results[3] = data.three.z;
  results[4] = data.columns[1].x;
  results[5] = data.rows[0].y; results[6] = data.rows[1].z;
  f16vec3 v = data.rows * f16vec2(1, 10);
  results[7] = v.x; results[8] = v.y; results[9] = v.z;
  results[10] = data.more[1];
  results[11] = pushed.p; results[12] = pushed.q.x; results[13] = pushed.q.y;
  for (int i = 0; i < 3; ++i) results[14 + i] = table[i];
  Pair p; float16_t s = data.two;
  f16vec2 t = twice(pushed.q, s, p);
  results[17] = t.y; results[18] = s; results[19] = p.b.x;
  Pair copy = pairs[1];
  copy.b = copy.b.yx;
  pairs[2] = copy;
  results[20] = factor;
  float16_t whole; int e;
  results[21] = modf(float16_t(-2.75), whole);
  results[22] = frexp(data.more[0], e) + whole;
  results[23] = float16_t(e);
})",
         options)
      .run({resource(in), resource(out), resource(scalars)}, {1}, std::as_bytes(std::span(pushed)));
  CHECK(out == halves({3,    3,     4,   5,      8,    12,   15, 120,  142, 164,   17,      0.5,
                       0.25, 0.125, 0.1, -65504, 6e-8, 0.25, 4,  0.25, 3,   -0.75, 0.5 - 2, 5}));
  CHECK(scalars == halves({1, 2, 3, 4, 5, 6, 4, 6, 5}));
}

TEST_CASE("bits of halves are bits of other types") {
  const std::vector<std::uint64_t> results = evaluate<std::uint64_t>("uint64_t", 8, R"(
    float16_t one = float16_t(result.length()) / float16_t(8);
    f16vec2 two = f16vec2(one, -one);
    f16vec4 four = f16vec4(two, float16_t(2) * two);
    result[0] = uint64_t(packFloat2x16(two));
    result[1] = pack64(unpack16(packFloat2x16(two)).xyxy);
    result[2] = uint64_t(float16BitsToUint16(one)) + uint64_t(uint(int(float16BitsToInt16(two.y))));
    result[3] = uint64_t(float16BitsToUint16(unpackFloat2x16(0x12345678u).y));
    result[4] = uint64_t(float16BitsToUint16(uint16BitsToFloat16(uint16_t(0x3555))));
    result[5] = uint64_t(packHalf2x16(vec2(two)));
    result[6] = pack64(float16BitsToUint16(four));
    result[7] = uint64_t(floatBitsToUint(float(uint16BitsToFloat16(uint16_t(0xfbff)))));
  )",
                                                                     extensions);
  CHECK(results == std::vector<std::uint64_t>{0xbc003c00u, 0xbc003c00bc003c00u, 0x3c00u + 0xffffbc00u, 0x1234, 0x3555,
                                              0xbc003c00u, 0xc0004000bc003c00u, 0xc77fe000u});
}

TEST_CASE("modf and frexp store the second result in a buffer") {
  std::vector<float> floats = {-5.25f, 0, 0, 0, 12.0f, 0, 0, 0};
  std::vector<std::int32_t> exponents(4);
  Kernel(extensions + R"(
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Floats { float x[4]; vec2 v, w; };
layout(std430, binding = 1) buffer Exponents { int e; ivec2 f; };
void main() {
  x[2] = modf(x[0], x[1]);
  for (int i = 0; i < 1; x[3] = frexp(x[0], e), ++i) {}
  w = frexp(v, f);
})",
         {})
      .run({resource(floats), resource(exponents)});
  CHECK(floats == std::vector<float>{-5.25f, -5.0f, -0.25f, -0.65625f, 12.0f, 0.0f, 0.75f, 0.0f});
  CHECK(exponents == std::vector<std::int32_t>{3, 0, 4, 0});
}

TEST_CASE("a conversion to a half rounds as it is decorated") {
  const std::string text = R"(
OpCapability Shader
OpCapability StorageBuffer16BitAccess
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %floats %halves
OpExecutionMode %main LocalSize 1 1 1
OpDecorate %nearest FPRoundingMode RTE
OpDecorate %truncated FPRoundingMode RTZ
OpMemberDecorate %float_block 0 Offset 0
OpDecorate %float_block Block
OpMemberDecorate %half_block 0 Offset 0
OpMemberDecorate %half_block 1 Offset 2
OpDecorate %half_block Block
OpDecorate %floats DescriptorSet 0
OpDecorate %floats Binding 0
OpDecorate %halves DescriptorSet 0
OpDecorate %halves Binding 1
%void = OpTypeVoid
%signature = OpTypeFunction %void
%uint = OpTypeInt 32 0
%float = OpTypeFloat 32
%half = OpTypeFloat 16
%zero = OpConstant %uint 0
%one = OpConstant %uint 1
%float_block = OpTypeStruct %float
%half_block = OpTypeStruct %half %half
%float_block_pointer = OpTypePointer StorageBuffer %float_block
%half_block_pointer = OpTypePointer StorageBuffer %half_block
%float_pointer = OpTypePointer StorageBuffer %float
%half_pointer = OpTypePointer StorageBuffer %half
%floats = OpVariable %float_block_pointer StorageBuffer
%halves = OpVariable %half_block_pointer StorageBuffer
%main = OpFunction %void None %signature
%entry = OpLabel
%place = OpAccessChain %float_pointer %floats %zero
%x = OpLoad %float %place
%nearest = OpFConvert %half %x
%truncated = OpFConvert %half %x
%first = OpAccessChain %half_pointer %halves %zero
%second = OpAccessChain %half_pointer %halves %one
OpStore %first %nearest
OpStore %second %truncated
OpReturn
OpFunctionEnd
)";
  const Kernel shader(tandem::test::assembled(text), {});
  for (const float x : {1.0009f, -1.0009f, 0.1f, 70000.0f, -70000.0f, 3e-8f, 2.0f, 65519.0f}) {
    CAPTURE(x);
    std::vector<float> floats = {x};
    std::vector<std::uint16_t> results(2);
    shader.run({resource(floats), resource(results)});
    const std::uint16_t nearest = nearest_half(x);
    const bool is_beyond = std::fabs(half_value(nearest)) > std::fabs(static_cast<double>(x));
    CHECK(results[0] == nearest);
    CHECK(results[1] == nearest - is_beyond);
  }
}

}  // namespace
