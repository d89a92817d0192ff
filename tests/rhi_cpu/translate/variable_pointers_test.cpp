// Pointers into storage buffers as values.

#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "rhi/error.hpp"
#include "rhi_cpu/translate/translate.hpp"
#include "tests/rhi_cpu/translate/assembly.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::test::assembled;
using tandem::test::Kernel;
using tandem::test::KernelOptions;
using tandem::test::resource;

/// Two buffers of floats, %a and %b, and one of results; `body` is the rest of main.
std::string module(const std::string& functions, const std::string& body, const std::string& globals = "") {
  return R"(
OpCapability Shader
OpCapability VariablePointers
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %a %b %results %kept
OpExecutionMode %main LocalSize 1 1 1
OpDecorate %array ArrayStride 4
OpDecorate %element ArrayStride 4
OpMemberDecorate %block 0 Offset 0
OpDecorate %block Block
OpDecorate %a DescriptorSet 0
OpDecorate %a Binding 0
OpDecorate %b DescriptorSet 0
OpDecorate %b Binding 1
OpDecorate %results DescriptorSet 0
OpDecorate %results Binding 2
%void = OpTypeVoid
%signature = OpTypeFunction %void
%bool = OpTypeBool
%int = OpTypeInt 32 1
%uint = OpTypeInt 32 0
%float = OpTypeFloat 32
%n0 = OpConstant %int 0
%n1 = OpConstant %int 1
%n2 = OpConstant %int 2
%n3 = OpConstant %int 3
%n4 = OpConstant %int 4
%n5 = OpConstant %int 5
%n6 = OpConstant %int 6
%n7 = OpConstant %int 7
%minus1 = OpConstant %int -1
%zero = OpConstant %float 0
%two = OpConstant %float 2
%array = OpTypeRuntimeArray %float
%block = OpTypeStruct %array
%pointer = OpTypePointer StorageBuffer %block
%element = OpTypePointer StorageBuffer %float
%place = OpTypePointer Function %element
%private_place = OpTypePointer Private %element
%null = OpConstantNull %element
%kept = OpVariable %private_place Private
%moved_signature = OpTypeFunction %element %element %int
%a = OpVariable %pointer StorageBuffer
%b = OpVariable %pointer StorageBuffer
%results = OpVariable %pointer StorageBuffer
)" + globals +
         functions + "%main = OpFunction %void None %signature\n%entry = OpLabel\n" + body +
         "OpReturn\nOpFunctionEnd\n";
}

std::string result(int place, const std::string& value) {
  const std::string n = std::to_string(place);
  return "%result" + n + " = OpAccessChain %element %results %n0 %n" + n + "\nOpStore %result" + n + " " + value + "\n";
}

TEST_CASE("pointers are picked, passed, stored, compared and counted") {
  const std::string functions = R"(
%moved = OpFunction %element None %moved_signature
%from = OpFunctionParameter %element
%by = OpFunctionParameter %int
%moved_entry = OpLabel
%to = OpPtrAccessChain %element %from %by
OpReturnValue %to
OpFunctionEnd
)";
  const std::string body = R"(
%variable = OpVariable %place Function
%a1 = OpAccessChain %element %a %n0 %n1
%b2 = OpAccessChain %element %b %n0 %n2
%a1_value = OpLoad %float %a1
%is_two = OpFOrdEqual %bool %a1_value %two
%picked = OpSelect %element %is_two %b2 %a1
%r0 = OpLoad %float %picked
%next = OpFunctionCall %element %moved %picked %n1
%r1 = OpLoad %float %next
OpStore %variable %next
OpStore %kept %a1
%again = OpLoad %element %variable
%again_back = OpPtrAccessChain %element %again %minus1
%kept_again = OpLoad %element %kept
%r2 = OpLoad %float %kept_again
OpStore %again_back %r1
%same = OpPtrEqual %bool %again_back %b2
%other = OpPtrNotEqual %bool %again_back %b2
%not_null = OpPtrNotEqual %bool %again_back %null
%steps = OpPtrDiff %int %b2 %again
%both = OpLogicalAnd %bool %same %not_null
%r3 = OpSelect %float %both %two %zero
%r4 = OpSelect %float %other %two %zero
%r5 = OpConvertSToF %float %steps
%copy = OpCopyObject %pointer %b
%length = OpArrayLength %uint %copy 0
%r6 = OpConvertUToF %float %length
)" + result(0, "%r0") + result(1, "%r1") +
                           result(2, "%r2") + result(3, "%r3") + result(4, "%r4") + result(5, "%r5") + result(6, "%r6");
  for (const bool optimize : {false, true}) {
    CAPTURE(optimize);
    KernelOptions options;
    options.optimize = optimize;
    std::vector<float> a = {1, 2, 3, 4}, b = {10, 20, 30, 40}, results(7, -1);
    Kernel(assembled(module(functions, body)), options).run({resource(a), resource(b), resource(results)});
    CHECK(results == std::vector<float>{30, 40, 2, 2, 0, -1, 4});
    CHECK(b == std::vector<float>{10, 20, 40, 40});
  }
}

TEST_CASE("a pointer moves through a loop and out of it; a buffer is picked by an OpPhi") {
  const std::string body = R"(
%a0 = OpAccessChain %element %a %n0 %n0
%a0_value = OpLoad %float %a0
%is_two = OpFOrdEqual %bool %a0_value %two
OpSelectionMerge %joined None
OpBranchConditional %is_two %left %right
%left = OpLabel
OpBranch %joined
%right = OpLabel
OpBranch %joined
%joined = OpLabel
%which = OpPhi %pointer %a %left %b %right
%start = OpAccessChain %element %which %n0 %n1
OpBranch %header
%header = OpLabel
%at = OpPhi %element %start %joined %further %continue
%sum = OpPhi %float %zero %joined %more %continue
OpLoopMerge %done %continue None
OpBranch %inside
%inside = OpLabel
%value = OpLoad %float %at
%more = OpFAdd %float %sum %value
%chosen = OpSelect %element %is_two %start %at
%beyond = OpFOrdGreaterThan %bool %more %two
OpBranchConditional %beyond %done %continue
%continue = OpLabel
%further = OpPtrAccessChain %element %at %n1
OpBranch %header
%done = OpLabel
%r1 = OpLoad %float %chosen
)" + result(0, "%more") + result(1, "%r1");
  for (const bool optimize : {false, true}) {
    CAPTURE(optimize);
    KernelOptions options;
    options.optimize = optimize;
    std::vector<float> a = {1, 20, 30, 40}, b = {10, 0.5f, 0.25f, 4, 100}, results(2, -1);
    const Kernel kernel(assembled(module("", body)), options);
    kernel.run({resource(a), resource(b), resource(results)});
    CHECK(results == std::vector<float>{4.75f, 4});
    a[0] = 2;
    kernel.run({resource(a), resource(b), resource(results)});
    CHECK(results == std::vector<float>{20, 20});
  }
}

TEST_CASE("a pointer that would need a stride is refused as a value") {
  const std::string globals = R"(
%vec2 = OpTypeVector %float 2
%mat2 = OpTypeMatrix %vec2 2
%rows = OpTypeStruct %mat2
%rows_pointer = OpTypePointer StorageBuffer %rows
%column = OpTypePointer StorageBuffer %vec2
%matrices = OpVariable %rows_pointer StorageBuffer
)";
  const std::string body = R"(
%column0 = OpAccessChain %column %matrices %n0 %n0
%column1 = OpAccessChain %column %matrices %n0 %n1
%picked = OpSelect %column %yes %column0 %column1
%value = OpLoad %vec2 %picked
)";
  std::string text = module("", body, globals + "%yes = OpConstantTrue %bool\n");
  text.insert(text.find("%void ="), R"(OpMemberDecorate %rows 0 Offset 0
OpMemberDecorate %rows 0 MatrixStride 8
OpMemberDecorate %rows 0 RowMajor
OpDecorate %rows Block
OpDecorate %matrices DescriptorSet 0
OpDecorate %matrices Binding 3
)");
  text.insert(text.find(" %kept\n") + 6, " %matrices");
  CHECK_THROWS_WITH_AS(tandem::cpu::translate(assembled(text), "a label"),
                       "a label: a pointer to a matrix, or to a column of a row-major one, as a value is not supported "
                       "by the CPU device",
                       tandem::rhi::Error);
}

TEST_CASE("pointers to matrices and their columns are compared, and pointers without a stride counted by their array") {
  const std::string globals = R"(
%vec2 = OpTypeVector %float 2
%mat2 = OpTypeMatrix %vec2 2
%vectors = OpTypeRuntimeArray %vec2
%rows = OpTypeStruct %mat2 %mat2 %vectors
%rows_pointer = OpTypePointer StorageBuffer %rows
%matrix_pointer = OpTypePointer StorageBuffer %mat2
%vector_pointer = OpTypePointer StorageBuffer %vec2
%matrices = OpVariable %rows_pointer StorageBuffer
)";
  const std::string body = R"(
%matrix0 = OpAccessChain %matrix_pointer %matrices %n0
%matrix1 = OpAccessChain %matrix_pointer %matrices %n1
%column0 = OpAccessChain %vector_pointer %matrices %n0 %n0
%column0_again = OpAccessChain %vector_pointer %matrix0 %n0
%column1 = OpAccessChain %vector_pointer %matrices %n0 %n1
%vector1 = OpAccessChain %vector_pointer %matrices %n2 %n1
%vector6 = OpAccessChain %vector_pointer %matrices %n2 %n6
%same_matrix = OpPtrEqual %bool %matrix0 %matrix1
%same_column = OpPtrEqual %bool %column0 %column0_again
%other_column = OpPtrNotEqual %bool %column0 %column1
%steps = OpPtrDiff %int %vector6 %vector1
%r0 = OpSelect %float %same_matrix %two %zero
%r1 = OpSelect %float %same_column %two %zero
%r2 = OpSelect %float %other_column %two %zero
%r3 = OpConvertSToF %float %steps
)" + result(0, "%r0") + result(1, "%r1") +
                           result(2, "%r2") + result(3, "%r3");
  std::string text = module("", body, globals);
  // An element of %vectors has half the bytes from it to the next.
  text.insert(text.find("%void ="), R"(OpMemberDecorate %rows 0 Offset 0
OpMemberDecorate %rows 0 MatrixStride 8
OpMemberDecorate %rows 0 RowMajor
OpMemberDecorate %rows 1 Offset 16
OpMemberDecorate %rows 1 MatrixStride 8
OpMemberDecorate %rows 1 ColMajor
OpMemberDecorate %rows 2 Offset 32
OpDecorate %vectors ArrayStride 16
OpDecorate %rows Block
OpDecorate %matrices DescriptorSet 0
OpDecorate %matrices Binding 3
)");
  text.insert(text.find(" %kept\n") + 6, " %matrices");
  std::vector<float> results(4, -1), matrices(40);
  Kernel(assembled(text), {}).run({resource(results), resource(matrices)});
  CHECK(results == std::vector<float>{0, 2, 2, 5});
}

}  // namespace
