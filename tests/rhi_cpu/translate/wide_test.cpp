// The wide form: what the lanes of a kernel write is what the scalar form writes.

#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/rhi_cpu/translate/assembly.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::test::compute_spirv;
using tandem::test::Kernel;
using tandem::test::resource;

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t invocation_count = 21;

/// What each of 21 invocations writes into its element of `own`; `data` has the numbers 0, 1, 2... The statements know
/// the number of the invocation as `id`.
Words written(const std::string& statements, const std::string& declarations, std::uint32_t lanes,
              bool optimize = false) {
  const std::string source =
      "layout(local_size_x = 7) in;\nlayout(std430, binding = 0) buffer Own { uint own[]; };\n"
      "layout(std430, binding = 1) readonly buffer Data { uint data[]; };\n" +
      declarations + "\nvoid main() {\n  uint id = gl_GlobalInvocationID.x;\n" + statements + "\n}\n";
  Words own(invocation_count), data(64);
  for (std::uint32_t i = 0; i < data.size(); ++i) data[i] = i;
  Kernel(compute_spirv(source), {.specialization = {}, .optimize = optimize, .more_options = {}, .lanes = lanes})
      .run({resource(own), resource(data)}, {3});
  return own;
}

void check_lanes(const std::string& statements, const std::string& declarations = "") {
  const Words expected = written(statements, declarations, 0);
  CHECK(written(statements, declarations, 4) == expected);
  CHECK(written(statements, declarations, 4, true) == expected);
}

}  // namespace

TEST_CASE("in lanes: a loop that all leave together, by a condition that the edge back sets") {
  check_lanes(R"(
  bool again = true, last;
  uint a = data[5], b = 1u;
  int k = 0;
  do {
    a = a + 3u;
    b = b * 5u + a;
    last = again;
    again = ++k < 4;
  } while (last);
  own[id] = a + b + id;)");
}

TEST_CASE("in lanes: an address from a loop that lanes leave in different rounds") {
  check_lanes(R"(
  do own[id]++; while (own[id] < data[id * 2 & 15]);
  own[id] *= 3;)");
}

TEST_CASE("in lanes: what a function writes through a pointer beside its result") {
  check_lanes(R"(
  float x = float(data[7]) * 0.75, y = float(id) * 0.75, whole;
  own[id] = uint(modf(x, all) * 8.0) + uint(all) * 100u;
  own[id] += uint(modf(y, whole) * 8.0) * 10000u + uint(whole);
  own[id] += uint(modf(x, whole) * 8.0) * 1000000u + uint(whole);)",
              "float all = 0.0;");
}

TEST_CASE("in lanes: a product with a constant zero has its factor's sign, or is NaN") {
  // spirv-opt may make 0 of it, which is not for the translator to do.
  const std::string statements = R"(
  float factor = uintBitsToFloat(id % 3u == 0u ? 0xbf800000u : id % 3u == 1u ? 0x7f800000u : 0x3f800000u);
  vec3 product = vec3(0.0) * factor;
  vec2 column = mat2(0.0) * vec2(factor);
  own[id] = (isnan(product.y) ? 1u : floatBitsToUint(product.y) >> 30) +
            10u * (isnan(column.x) ? 1u : floatBitsToUint(column.x) >> 30) +
            100u * uint(isnan(dot(vec2(0.0), vec2(factor))));)";
  CHECK(written(statements, "", 8) == written(statements, "", 0));
}

TEST_CASE("in lanes: memory that is copied, from a buffer to a variable and on to another one, by some of the lanes") {
  const std::string module = R"(
               OpCapability Shader
               OpMemoryModel Logical GLSL450
               OpEntryPoint GLCompute %main "main" %invocation
               OpExecutionMode %main LocalSize 7 1 1
               OpDecorate %invocation BuiltIn GlobalInvocationId
               OpDecorate %array ArrayStride 4
               OpDecorate %block BufferBlock
               OpMemberDecorate %block 0 Offset 0
               OpDecorate %own DescriptorSet 0
               OpDecorate %own Binding 0
               OpDecorate %data DescriptorSet 0
               OpDecorate %data Binding 1
       %void = OpTypeVoid
   %function = OpTypeFunction %void
       %bool = OpTypeBool
       %uint = OpTypeInt 32 0
      %uint3 = OpTypeVector %uint 3
      %input = OpTypePointer Input %uint3
 %invocation = OpVariable %input Input
      %array = OpTypeRuntimeArray %uint
      %block = OpTypeStruct %array
 %block_pointer = OpTypePointer Uniform %block
  %word_pointer = OpTypePointer Uniform %uint
 %local_pointer = OpTypePointer Function %uint
        %own = OpVariable %block_pointer Uniform
       %data = OpVariable %block_pointer Uniform
       %zero = OpConstant %uint 0
        %one = OpConstant %uint 1
      %seven = OpConstant %uint 7
       %main = OpFunction %void None %function
      %begin = OpLabel
      %first = OpVariable %local_pointer Function
     %second = OpVariable %local_pointer Function
        %ids = OpLoad %uint3 %invocation
         %id = OpCompositeExtract %uint %ids 0
               OpStore %second %seven
        %odd = OpBitwiseAnd %uint %id %one
     %is_odd = OpINotEqual %bool %odd %zero
     %source = OpAccessChain %word_pointer %data %zero %id
     %target = OpAccessChain %word_pointer %own %zero %id
               OpSelectionMerge %after None
               OpBranchConditional %is_odd %copies %after
     %copies = OpLabel
               OpCopyMemory %first %source
               OpCopyMemory %second %first
               OpBranch %after
      %after = OpLabel
               OpCopyMemory %target %second
               OpReturn
               OpFunctionEnd
)";
  const std::vector<std::uint32_t> spirv = tandem::test::assembled(module, SPV_ENV_UNIVERSAL_1_3);
  Words data(64), expected(invocation_count);
  for (std::uint32_t i = 0; i < data.size(); ++i) data[i] = 100 + i;
  for (std::uint32_t i = 0; i < invocation_count; ++i) expected[i] = i % 2 != 0 ? data[i] : 7;
  for (const std::uint32_t lanes : {0u, 4u, 8u}) {
    CAPTURE(lanes);
    Words own(invocation_count);
    Kernel(spirv, {.specialization = {}, .optimize = false, .more_options = {}, .lanes = lanes})
        .run({resource(own), resource(data)}, {3});
    CHECK(own == expected);
  }
}
