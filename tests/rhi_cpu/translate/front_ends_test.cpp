// What glslang never writes, and other front ends or other versions of GLSL do.

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <spirv-tools/libspirv.hpp>

#include "rhi/glsl/compile.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::test::Kernel;
using tandem::test::resource;

/// A module whose main has `statements` and stores %r0, %r1, ... in the elements of a buffer of that type of 32 bits.
std::vector<std::uint32_t> module(const std::string& type, const std::string& declarations,
                                  const std::string& statements, int results) {
  std::string text = R"(
    OpCapability Shader
    OpCapability Int64
    %glsl = OpExtInstImport "GLSL.std.450"
    OpMemoryModel Logical GLSL450
    OpEntryPoint GLCompute %main "main" %buffer
    OpExecutionMode %main LocalSize 1 1 1
    OpDecorate %array ArrayStride 4
    OpMemberDecorate %block 0 Offset 0
    OpDecorate %block Block
    OpDecorate %buffer DescriptorSet 0
    OpDecorate %buffer Binding 0
    %void = OpTypeVoid
    %function = OpTypeFunction %void
    %uint = OpTypeInt 32 0
    %int = OpTypeInt 32 1
    %long = OpTypeInt 64 1
    %float = OpTypeFloat 32
    %zero = OpConstant %uint 0
    %array = OpTypeRuntimeArray )" +
                     type + R"(
    %block = OpTypeStruct %array
    %pointer = OpTypePointer StorageBuffer %block
    %element = OpTypePointer StorageBuffer )" +
                     type + R"(
    %buffer = OpVariable %pointer StorageBuffer
    )" + declarations;
  for (int i = 0; i < results; ++i)
    text += "%i" + std::to_string(i) + " = OpConstant %uint " + std::to_string(i) + "\n";
  text += "%main = OpFunction %void None %function\n%entry = OpLabel\n" + statements;
  for (int i = 0; i < results; ++i) {
    const std::string n = std::to_string(i);
    text += "%p" + n + " = OpAccessChain %element %buffer %zero %i" + n + "\nOpStore %p" + n + " %r" + n + "\n";
  }
  text += "OpReturn\nOpFunctionEnd\n";
  const spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_2);
  std::vector<std::uint32_t> words;
  REQUIRE(tools.Assemble(text, &words));
  REQUIRE(tools.Validate(words));
  return words;
}

/// What such a module stores.
template <typename T>
std::vector<T> stored(const std::string& type, const std::string& declarations, const std::string& statements,
                      std::size_t count) {
  std::vector<T> result(count);
  Kernel(module(type, declarations, statements, static_cast<int>(count)), {}).run({resource(result)});
  return result;
}

}  // namespace

TEST_CASE("a product of double width goes by its operation, not by the type of its operands") {
  const std::string declarations = R"(
    %pair = OpTypeStruct %uint %uint
    %minus_three = OpConstant %uint 4294967293
    %two = OpConstant %uint 2
  )";
  const std::string statements = R"(
    %signed = OpSMulExtended %pair %minus_three %two
    %unsigned = OpUMulExtended %pair %minus_three %two
    %r0 = OpCompositeExtract %uint %signed 0
    %r1 = OpCompositeExtract %uint %signed 1
    %r2 = OpCompositeExtract %uint %unsigned 1
  )";
  const std::vector<std::uint32_t> result = stored<std::uint32_t>("%uint", declarations, statements, 3);
  CHECK(result == std::vector<std::uint32_t>{0xfffffffau, 0xffffffffu, 1u});
}

TEST_CASE("products of double width have every width") {
  const std::string declarations = R"(
    %ulong = OpTypeInt 64 0
    %pair = OpTypeStruct %long %long
    %unsigned_pair = OpTypeStruct %ulong %ulong
    %minus_three = OpConstant %long -3
    %large = OpConstant %long 9223372036854775807
    %unsigned_minus_three = OpConstant %ulong 18446744073709551613
    %unsigned_large = OpConstant %ulong 9223372036854775807
  )";
  const std::string statements = R"(
    %signed = OpSMulExtended %pair %minus_three %large
    %unsigned = OpUMulExtended %unsigned_pair %unsigned_minus_three %unsigned_large
    %signed_high = OpCompositeExtract %long %signed 1
    %unsigned_high = OpCompositeExtract %ulong %unsigned 1
    %low = OpCompositeExtract %long %signed 0
    %signed_bits = OpBitcast %ulong %signed_high
    %low_bits = OpBitcast %ulong %low
    %r0 = OpUConvert %uint %signed_bits
    %r1 = OpUConvert %uint %unsigned_high
    %r2 = OpUConvert %uint %low_bits
  )";
  const std::vector<std::uint32_t> result = stored<std::uint32_t>("%uint", declarations, statements, 3);
  // -3 (2^63 - 1) is -2 times 2^64 and 2^63 + 3; of 2^64 - 3 and 2^63 - 1 the upper half is 2^63 - 3.
  CHECK(result == std::vector<std::uint32_t>{0xfffffffeu, 0xfffffffdu, 3u});
}

TEST_CASE("ldexp takes exponents of 64 bits") {
  const std::string declarations = R"(
    %one = OpConstant %float 1.5
    %minus_one = OpConstant %float -1.5
    %lowest = OpConstant %long -9223372036854775808
    %highest = OpConstant %long 9223372036854775807
    %wraps = OpConstant %long 4294967299
    %three = OpConstant %long 3
  )";
  const std::string statements = R"(
    %r0 = OpExtInst %float %glsl Ldexp %minus_one %lowest
    %r1 = OpExtInst %float %glsl Ldexp %one %highest
    %r2 = OpExtInst %float %glsl Ldexp %one %wraps
    %r3 = OpExtInst %float %glsl Ldexp %one %three
  )";
  const std::vector<float> result = stored<float>("%float", declarations, statements, 4);
  CHECK(result[0] == 0);
  CHECK(std::signbit(result[0]));
  CHECK(std::isinf(result[1]));
  CHECK(std::isinf(result[2]));
  CHECK(result[3] == 12);
}

TEST_CASE("shaders of OpenGL ES have precisions, which mean nothing here") {
  const std::string source = R"(#version 310 es
    precision mediump float;
    layout(local_size_x = 1) in;
    layout(std430, binding = 0) buffer Result { highp float result[]; };
    mediump float twice(lowp float x) { mediump float y = x + x; return y; }
    void main() {
      mediump float value = 0.0;
      for (lowp int i = 0; i < 3; ++i) value = twice(value) + 1.0;
      result[0] = value;
    })";
  std::vector<float> result(1);
  Kernel(tandem::glsl::compile(source, tandem::rhi::ShaderStage::compute, "es.comp"), {}).run({resource(result)});
  CHECK(result[0] == 7);
}

TEST_CASE("an index beyond a vector is some component, not the end of the process") {
  std::vector<std::uint32_t> result(1), index = {5};
  Kernel(R"(
    layout(local_size_x = 1) in;
    layout(std430, binding = 0) buffer Result { uint result[]; };
    layout(std430, binding = 1) readonly buffer In { uint index[]; };
    void main() {
      uvec3 v = uvec3(7u, 8u, 9u);
      result[0] = v[index[0]];
    })")
      .run({resource(result), resource(index)});
  CHECK(result[0] >= 7);
  CHECK(result[0] <= 9);
}
