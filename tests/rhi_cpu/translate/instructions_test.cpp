// Instructions that glslang 12 has no GLSL for, and extensions of few instructions.

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "rhi/shader_reflection.hpp"
#include "tests/rhi_cpu/translate/assembly.hpp"
#include "tests/rhi_cpu/translate/half_reference.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::test::assembled;
using tandem::test::Kernel;
using tandem::test::KernelOptions;
using tandem::test::nearest_half;
using tandem::test::resource;

/// A module that stores the uints `values` one after the other, computed by `body`.
std::string module(const std::string& capabilities, const std::string& types, const std::string& body,
                   const std::vector<std::string>& values, const std::string& decorations = "") {
  std::string text = "OpCapability Shader\n" + capabilities + R"(
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %results
OpExecutionMode %main LocalSize 1 1 1
OpDecorate %array ArrayStride 4
OpMemberDecorate %block 0 Offset 0
OpDecorate %block Block
OpDecorate %results DescriptorSet 0
OpDecorate %results Binding 0
)" + decorations + R"(
%void = OpTypeVoid
%signature = OpTypeFunction %void
%bool = OpTypeBool
%int = OpTypeInt 32 1
%uint = OpTypeInt 32 0
%float = OpTypeFloat 32
%array = OpTypeRuntimeArray %uint
%block = OpTypeStruct %array
%pointer = OpTypePointer StorageBuffer %block
%element = OpTypePointer StorageBuffer %uint
%results = OpVariable %pointer StorageBuffer
%n0 = OpConstant %uint 0
)";
  for (std::size_t i = 1; i < values.size(); ++i)
    text += "%n" + std::to_string(i) + " = OpConstant %uint " + std::to_string(i) + "\n";
  text += types + "%main = OpFunction %void None %signature\n%entry = OpLabel\n" + body;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string n = std::to_string(i);
    text += "%place" + n + " = OpAccessChain %element %results %n0 %n" + n + "\nOpStore %place" + n + " " + values[i] +
            "\n";
  }
  return text + "OpReturn\nOpFunctionEnd\n";
}

std::vector<std::uint32_t> stored(const std::string& text, std::size_t count, KernelOptions options = {}) {
  std::vector<std::uint32_t> results(count);
  Kernel(assembled(text), options).run({resource(results)});
  return results;
}

TEST_CASE("integer dot products, packed and not, with and without accumulation") {
  const std::string capabilities = R"(
OpCapability Int8
OpCapability Int16
OpCapability Int64
OpCapability DotProduct
OpCapability DotProductInputAll
OpCapability DotProductInput4x8Bit
OpCapability DotProductInput4x8BitPacked
OpExtension "SPV_KHR_integer_dot_product"
)";
  const std::string types = R"(
%byte = OpTypeInt 8 1
%ubyte = OpTypeInt 8 0
%short = OpTypeInt 16 1
%long = OpTypeInt 64 1
%ulong = OpTypeInt 64 0
%byte4 = OpTypeVector %byte 4
%ubyte4 = OpTypeVector %ubyte 4
%short3 = OpTypeVector %short 3
%int2 = OpTypeVector %int 2
%bm1 = OpConstant %byte -1
%b2 = OpConstant %byte 2
%bm128 = OpConstant %byte -128
%b127 = OpConstant %byte 127
%u255 = OpConstant %ubyte 255
%u2 = OpConstant %ubyte 2
%a = OpConstantComposite %byte4 %bm1 %b2 %bm128 %b127
%b = OpConstantComposite %byte4 %b2 %bm1 %bm128 %b127
%c = OpConstantComposite %ubyte4 %u255 %u2 %u255 %u2
%s = OpConstant %short -32768
%s1 = OpConstant %short 3
%shorts = OpConstantComposite %short3 %s %s1 %s
%large = OpConstant %int 2147483647
%less = OpConstant %int -5
%ints = OpConstantComposite %int2 %large %less
%packed_a = OpConstant %uint 0x7f8002ff
%packed_b = OpConstant %uint 0x7f80ff02
%near_end = OpConstant %int 2147483640
%near_start = OpConstant %int -2147483640
%near_uint_end = OpConstant %uint 4294967290
%short_accumulator = OpConstant %short 32000
%shift32 = OpConstant %uint 32
)";
  const std::string body = R"(
%r0 = OpSDot %int %a %b
%r1 = OpUDot %uint %c %c
%r2 = OpSUDot %int %a %c
%r3 = OpSDot %int %packed_a %packed_b PackedVectorFormat4x8Bit
%r4 = OpUDot %uint %packed_a %packed_b PackedVectorFormat4x8Bit
%r5 = OpSUDot %int %packed_a %packed_b PackedVectorFormat4x8Bit
%r6 = OpSDotAccSat %int %a %b %near_end
%r7 = OpUDotAccSat %uint %packed_a %packed_b %near_uint_end PackedVectorFormat4x8Bit
%minus = OpSUDotAccSat %int %a %c %near_start
%r9 = OpSDotAccSat %int %packed_a %packed_b %less PackedVectorFormat4x8Bit
%wide = OpSDot %long %ints %ints
%wide_bits = OpBitcast %ulong %wide
%r10 = OpUConvert %uint %wide_bits
%high = OpShiftRightLogical %ulong %wide_bits %shift32
%r11 = OpUConvert %uint %high
%r12 = OpSDot %int %shorts %shorts
%small = OpSDotAccSat %short %a %b %short_accumulator
%r13 = OpSConvert %int %small
)";
  std::string conversions;
  std::vector<std::string> values;
  for (int k = 0; k <= 13; ++k) {
    const std::string n = std::to_string(k);
    const bool is_unsigned = k == 1 || k == 4 || k == 7 || k == 10 || k == 11;
    const std::string from = k == 8 ? "%minus" : "%r" + n;
    if (!is_unsigned) conversions += "%v" + n + " = OpBitcast %uint " + from + "\n";
    values.push_back(is_unsigned ? from : "%v" + n);
  }
  const std::vector<std::uint32_t> results = stored(module(capabilities, types, body + conversions, values), 14);
  const auto u = [](std::int64_t x) { return static_cast<std::uint32_t>(x); };
  const std::int64_t dot = -2 - 2 + 128 * 128 + 127 * 127;
  // The bytes of the packed words are those of a and b.
  const std::int64_t unsigned_dot = 255 * 2 + 2 * 255 + 128 * 128 + 127 * 127;
  const std::int64_t wide = 2147483647ll * 2147483647ll + 25;
  CHECK(results[0] == u(dot));
  CHECK(results[1] == 2u * (255 * 255 + 4));
  CHECK(results[2] == u(-255 + 4 - 128 * 255 + 254));
  CHECK(results[3] == u(dot));
  CHECK(results[4] == u(unsigned_dot));
  CHECK(results[5] == u(-2 + 2 * 255 - 128 * 128 + 127 * 127));
  CHECK(results[6] == 0x7fffffffu);
  CHECK(results[7] == 0xffffffffu);
  CHECK(results[8] == 0x80000000u);
  CHECK(results[9] == u(dot - 5));
  CHECK(results[10] == u(wide));
  CHECK(results[11] == u(wide >> 32));
  CHECK(results[12] == u(2ll * 32768 * 32768 + 9));
  CHECK(results[13] == 32767);
}

TEST_CASE("a float is quantised to what a half can hold and is normal") {
  const std::vector<float> inputs = {
      1.0f + 0.0009765625f / 2, 1.0f + 3 * 0.0009765625f / 2, -65519.0f, 65520.0f, 6.1e-5f, -3e-8f, 6.11e-5f, 0.1f};
  std::string types, body;
  std::vector<std::string> values;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const std::string n = std::to_string(i);
    types += "%in" + n + " = OpConstant %uint " + std::to_string(std::bit_cast<std::uint32_t>(inputs[i])) + "\n";
    body += "%f" + n + " = OpBitcast %float %in" + n + "\n%q" + n + " = OpQuantizeToF16 %float %f" + n + "\n%r" + n +
            " = OpBitcast %uint %q" + n + "\n";
    values.push_back("%r" + n);
  }
  const std::vector<std::uint32_t> results = stored(module("", types, body, values), inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    CAPTURE(inputs[i]);
    const bool is_normal = std::fabs(inputs[i]) >= std::ldexp(1.0f, -14);
    const double expected = is_normal ? tandem::test::rounded_to_half(inputs[i]) : std::copysign(0.0, inputs[i]);
    CHECK(results[i] == std::bit_cast<std::uint32_t>(static_cast<float>(expected)));
  }
}

TEST_CASE("promises change nothing") {
  const std::string capabilities = R"(
OpCapability ExpectAssumeKHR
OpExtension "SPV_KHR_expect_assume"
OpExtension "SPV_KHR_non_semantic_info"
OpExtension "SPV_GOOGLE_user_type"
OpExtension "SPV_GOOGLE_decorate_string"
%printf = OpExtInstImport "NonSemantic.DebugPrintf"
)";
  const std::string decorations =
      "OpDecorateId %seven UniformId %subgroup\nOpDecorateString %results UserTypeGOOGLE \"t\"\n";
  const std::string types =
      "%subgroup = OpConstant %uint 3\n%seven = OpConstant %uint 7\n%yes = OpConstantTrue %bool\n%undefined = OpUndef "
      "%uint\n";
  const std::string body = R"(
%r0 = OpExpectKHR %uint %seven %n1
OpAssumeTrueKHR %yes
%nothing = OpExtInst %void %printf 1 %format %r0
%r1 = OpIMul %uint %undefined %n0
)";
  std::string text = module(capabilities, types, body, {"%r0", "%r1"}, decorations);
  text.insert(text.find("OpDecorate"), "%format = OpString \"value %u\"\nOpModuleProcessed \"by hand\"\n");
  CHECK(stored(text, 2) == std::vector<std::uint32_t>{7, 0});
}

TEST_CASE("null arrays have the length of a specialisation constant") {
  const std::string decorations = "OpDecorate %length SpecId 5\n";
  const std::string types = R"(
%length = OpSpecConstant %uint 3
%list = OpTypeArray %uint %length
%holder = OpTypeStruct %list %uint
%place = OpTypePointer Function %holder
%part = OpTypePointer Function %uint
%nothing = OpConstantNull %holder
)";
  const std::string body = R"(
%variable = OpVariable %place Function %nothing
%last = OpISub %uint %length %n1
%at = OpAccessChain %part %variable %n0 %last
OpStore %at %length
%first = OpAccessChain %part %variable %n0 %n0
%r0 = OpLoad %uint %at
%r1 = OpLoad %uint %first
)";
  const std::string text = module("", types, body, {"%r0", "%r1"}, decorations);
  // Reflection comes before values are known.
  CHECK(tandem::rhi::reflect(assembled(text), "nulls").specialization_constants.size() == 1);
  CHECK(stored(text, 2) == std::vector<std::uint32_t>{3, 0});
  CHECK(stored(text, 2, {.specialization = {{5, 40}}, .more_options = {}}) == std::vector<std::uint32_t>{40, 0});
  CHECK(stored(text, 2, {.specialization = {{5, 1}}, .more_options = {}}) == std::vector<std::uint32_t>{1, 1});
}

TEST_CASE("selectors of 8, 16 and 64 bits, cases that fall through, and an end that is never reached") {
  const std::string capabilities = "OpCapability Int64\nOpCapability Int16\nOpCapability Int8\n";
  const std::string types = R"(
%long = OpTypeInt 64 1
%ushort = OpTypeInt 16 0
%byte = OpTypeInt 8 1
%selector = OpConstant %long -5000000000
%small = OpConstant %ushort 65535
%tiny = OpConstant %byte -3
%hundred = OpConstant %uint 100
)";
  // Zero from memory, so that nothing is known when the shader is compiled.
  const std::string body = R"(
%loaded_place = OpAccessChain %element %results %n0 %n0
%loaded = OpLoad %uint %loaded_place
%signed = OpBitcast %int %loaded
%wide_zero = OpSConvert %long %signed
%wide_selector = OpIAdd %long %selector %wide_zero
%small_zero = OpUConvert %ushort %loaded
%small_selector = OpIAdd %ushort %small %small_zero
%tiny_zero = OpSConvert %byte %signed
%tiny_selector = OpIAdd %byte %tiny %tiny_zero
OpSelectionMerge %merge None
OpSwitch %wide_selector %default -5000000000 %one 7 %two
%one = OpLabel
OpBranch %two
%two = OpLabel
%x = OpPhi %uint %n1 %one %n0 %entry
%y = OpIAdd %uint %x %hundred
OpBranch %merge
%default = OpLabel
OpBranch %merge
%merge = OpLabel
%r0 = OpPhi %uint %y %two %n2 %default
OpSelectionMerge %merge2 None
OpSwitch %small_selector %never 65535 %good2
%good2 = OpLabel
OpBranch %merge2
%never = OpLabel
OpUnreachable
%merge2 = OpLabel
OpSelectionMerge %merge3 None
OpSwitch %tiny_selector %default3 -3 %good3
%good3 = OpLabel
OpBranch %merge3
%default3 = OpLabel
OpBranch %merge3
%merge3 = OpLabel
%r1 = OpPhi %uint %hundred %good3 %n0 %default3
)";
  CHECK(stored(module(capabilities, types, body, {"%r0", "%r1", "%n2"}), 3) == std::vector<std::uint32_t>{101, 100, 2});
}

TEST_CASE("clocks do not go backwards") {
  std::vector<std::uint64_t> times(4);
  Kernel(R"(
#extension GL_ARB_shader_clock : require
#extension GL_EXT_shader_realtime_clock : require
#extension GL_ARB_gpu_shader_int64 : require
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Out { uint64_t times[4]; };
void main() {
  times[0] = clockARB();
  times[1] = packUint2x32(clock2x32ARB());
  times[2] = clockRealtimeEXT();
  times[3] = packUint2x32(clockRealtime2x32EXT());
})",
         {})
      .run({resource(times)});
  CHECK(times[0] != 0);
  CHECK(times[0] <= times[1]);
  CHECK(times[2] <= times[3]);
}

TEST_CASE("atomic sums, minima and maxima of floats of every width") {
  std::vector<std::uint16_t> halves = {nearest_half(1), nearest_half(1), nearest_half(1), nearest_half(5), 0x7e00, 0};
  std::vector<float> floats = {2, 2, 2, 2, std::nanf(""), 0};
  std::vector<double> doubles = {3, 3, 3, 3, 0, 0};
  Kernel(R"(
#extension GL_EXT_shader_atomic_float : require
#extension GL_EXT_shader_atomic_float2 : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 8) in;
layout(std430, binding = 0) buffer Halves { float16_t h[6]; };
layout(std430, binding = 1) buffer Floats { float f[6]; };
layout(std430, binding = 2) buffer Doubles { double d[6]; };
void main() {
  uint i = gl_LocalInvocationIndex;
  float x = float(i) - 3.0;
  atomicAdd(h[0], float16_t(0.125)); atomicMin(h[1], float16_t(x)); atomicMax(h[2], float16_t(x));
  atomicAdd(f[0], 0.125); atomicMin(f[1], x); atomicMax(f[2], x);
  atomicAdd(d[0], 0.125lf); atomicMin(d[1], double(x)); atomicMax(d[2], double(x));
  if (i == 0) {
    h[5] = atomicExchange(h[3], float16_t(7));
    atomicMin(h[4], float16_t(-1));
    f[5] = atomicExchange(f[3], 9.0);
    atomicMax(f[4], -1.0);
    d[5] = atomicExchange(d[3], 11.0lf);
  }
})",
         {})
      .run({resource(halves), resource(floats), resource(doubles)});
  std::vector<std::uint16_t> expected;
  for (const double x : {2.0, -3.0, 4.0, 7.0, -1.0, 5.0}) expected.push_back(nearest_half(x));
  CHECK(halves == expected);
  CHECK(floats == std::vector<float>{3, -3, 4, 9, -1, 2});
  CHECK(doubles == std::vector<double>{4, -3, 4, 11, 0, 3});
}

}  // namespace
