// Shared blocks with a layout, initialised shared variables, atomics, and what only SPIR-V can say of subgroups.

#include <doctest/doctest.h>

#include <bit>

#include "rhi/glsl/compile.hpp"
#include "tests/rhi_cpu/groups/device.hpp"
#include "tests/rhi_cpu/translate/assembly.hpp"

namespace tandem::cpu::test {
namespace {

TEST_CASE("shared blocks begin at the same place and have their own layouts") {
  const Words words = run(*device_with(8), R"(
#extension GL_EXT_shared_memory_block : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 32) in;
layout(binding = 0) buffer B { uint b[]; };
struct Item { uint8_t byte; uint16_t word; vec3 position; };
layout(scalar) shared Items { uint words[40]; } first;
shared Other { layout(offset = 16) uvec4 quads[6]; layout(row_major) mat3x2 m; } second;
layout(std430) shared Third { Item items[4]; } third;
void main() {
  uint i = gl_LocalInvocationIndex;
  first.words[i] = i * 0x01010101u;
  barrier();
  uint x = second.quads[i % 4].z;
  barrier();
  if (i == 0) third.items[1].word = uint16_t(0x1234);
  if (i == 1) third.items[1].position.y = 2.0;
  if (i == 2) second.m = mat3x2(1, 2, 3, 4, 5, 6);
  if (i == 3) first.words[20] += 7;
  barrier();
  b[i] = x;
  b[32 + i] = first.words[i];
  b[64 + i] = floatBitsToUint(second.m[2].y) + first.words[30 + b[96 + i]] + uint(third.items[1].word);
}
)",
                          Words(128, 1u << 30));
  for (std::uint32_t i = 0; i < 32; ++i) {
    CAPTURE(i);
    CHECK(words[i] == (4 + i % 4 * 4 + 2) * 0x01010101u);
    std::uint32_t expected = i * 0x01010101u;
    // Item has 32 bytes in std430: word at 34, position at 48.
    if (i == 8) expected = (expected & 0xffff) | 0x12340000;
    if (i == 13) expected = std::bit_cast<std::uint32_t>(2.0f);
    if (i == 20) expected += 7;
    // The matrix has rows of 16 bytes from 112 on.
    if (i >= 28 && i < 31) expected = std::bit_cast<std::uint32_t>(float(2 * (i - 28) + 1));
    CHECK(words[32 + i] == expected);
    CHECK(words[64 + i] == std::bit_cast<std::uint32_t>(6.0f) + 0x1234);
  }
}

TEST_CASE("initialised shared variables, and atomic operations of every width") {
  const Words words = run(*device_with(8), R"(
#extension GL_EXT_null_initializer : require
#extension GL_EXT_shader_atomic_float : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 64) in;
layout(binding = 0) buffer B { uint b[]; };
shared uvec2 zero[3] = {};
shared float sum;
shared double wide;
shared int64_t large;
shared uint16_t small[4];
shared vec4 parts;
shared uint order;
void main() {
  uint i = gl_LocalInvocationIndex;
  uint before = zero[i % 3].y;
  barrier();
  zero[i % 3].y = 5;
  atomicAdd(sum, 0.5);
  atomicAdd(wide, 0.25LF);
  atomicMax(large, int64_t(i) << 33);
  atomicAdd(parts.z, 1.0);
  small[i % 4] = uint16_t(i);
  atomicCompSwap(order, i, i + 1);
  barrier();
  b[gl_GlobalInvocationID.x] = before + uint(sum) + uint(wide * 4.0LF) + uint(large >> 33) + uint(parts.z) + uint(small[3]) + order;
}
)",
                          Words(128), 2);
  CHECK(words == Words(128, 32 + 64 + 63 + 64 + 63 + 64));
}

TEST_CASE("the instructions that came before GroupNonUniform") {
  glsl::CompileOptions options;
  options.spirv = glsl::SpirvVersion::v1_0;
  const Words spirv = glsl::compile(R"(#version 460
#extension GL_ARB_shader_ballot : require
#extension GL_ARB_shader_group_vote : require
#extension GL_ARB_gpu_shader_int64 : require
layout(local_size_x = 20) in;
layout(binding = 0) buffer B { uint b[]; };
void main() {
  uint i = gl_LocalInvocationIndex;
  if (i % 4 == 1) return;
  uint votes = uint(anyInvocationARB(i == 9)) | uint(allInvocationsARB(i < 16)) << 1 |
               uint(allInvocationsEqualARB(i / 8 == 1)) << 2;
  b[i] = uint(ballotARB(i % 2 == 0)) | readInvocationARB(i, 3) << 8 | readFirstInvocationARB(i) << 16 | votes << 24 |
         gl_SubGroupInvocationARB << 28;
}
)",
                                    rhi::ShaderStage::compute, "old.comp", options);
  const Words words = run(*device_with(8), spirv, Words(20));
  for (std::uint32_t i = 0; i < 20; ++i) {
    const std::uint32_t group = i / 8;
    const std::uint32_t votes = (group < 2 ? 2u : 0u) | 4u;
    const std::uint32_t even = group < 2 ? 0x55 : 0x5;
    CHECK(words[i] == (i % 4 == 1 ? 0 : even | (8 * group + 3) << 8 | 8 * group << 16 | votes << 24 | i % 8 << 28));
  }
}

TEST_CASE("pointers to blocks of shared memory are values, also to the beginning") {
  const Words spirv = tandem::test::assembled(R"(
OpCapability Shader
OpCapability VariablePointers
OpCapability WorkgroupMemoryExplicitLayoutKHR
OpExtension "SPV_KHR_workgroup_memory_explicit_layout"
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %index %b %low %high
OpExecutionMode %main LocalSize 16 1 1
OpDecorate %index BuiltIn LocalInvocationIndex
OpDecorate %array ArrayStride 4
OpDecorate %half ArrayStride 4
OpDecorate %block Block
OpDecorate %low_block Block
OpDecorate %high_block Block
OpMemberDecorate %block 0 Offset 0
OpMemberDecorate %low_block 0 Offset 0
OpMemberDecorate %high_block 0 Offset 64
OpDecorate %low Aliased
OpDecorate %high Aliased
OpDecorate %b DescriptorSet 0
OpDecorate %b Binding 0
%void = OpTypeVoid
%bool = OpTypeBool
%signature = OpTypeFunction %void
%uint = OpTypeInt 32 0
%zero = OpConstant %uint 0
%one = OpConstant %uint 1
%two = OpConstant %uint 2
%hundred = OpConstant %uint 100
%sixteen = OpConstant %uint 16
%semantics = OpConstant %uint 264
%input = OpTypePointer Input %uint
%index = OpVariable %input Input
%array = OpTypeRuntimeArray %uint
%block = OpTypeStruct %array
%buffer = OpTypePointer StorageBuffer %block
%b = OpVariable %buffer StorageBuffer
%element = OpTypePointer StorageBuffer %uint
%half = OpTypeArray %uint %sixteen
%low_block = OpTypeStruct %half
%high_block = OpTypeStruct %half
%half_pointer = OpTypePointer Workgroup %half
%low_pointer = OpTypePointer Workgroup %low_block
%high_pointer = OpTypePointer Workgroup %high_block
%word = OpTypePointer Workgroup %uint
%low = OpVariable %low_pointer Workgroup
%high = OpVariable %high_pointer Workgroup
%main = OpFunction %void None %signature
%entry = OpLabel
%i = OpLoad %uint %index
%odd = OpBitwiseAnd %uint %i %one
%is_odd = OpIEqual %bool %odd %one
%low_half = OpAccessChain %half_pointer %low %zero
%high_half = OpAccessChain %half_pointer %high %zero
%which = OpSelect %half_pointer %is_odd %low_half %high_half
%own = OpAccessChain %word %which %i
%value = OpIAdd %uint %i %hundred
OpStore %own %value
OpControlBarrier %two %two %semantics
%low_word = OpAccessChain %word %low %zero %i
%high_word = OpAccessChain %word %high %zero %i
%low_value = OpLoad %uint %low_word
%high_value = OpLoad %uint %high_word
%picked = OpSelect %uint %is_odd %low_value %high_value
%place = OpAccessChain %element %b %zero %i
OpStore %place %picked
OpReturn
OpFunctionEnd
)");
  const Words words = run(*device_with(8), spirv, Words(16));
  for (std::uint32_t i = 0; i < 16; ++i) CHECK(words[i] == 100 + i);
}

TEST_CASE("pointers into shared memory are values") {
  const Words spirv = tandem::test::assembled(R"(
OpCapability Shader
OpCapability VariablePointers
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %index %b %left %right %single
OpExecutionMode %main LocalSize 16 1 1
OpDecorate %index BuiltIn LocalInvocationIndex
OpDecorate %array ArrayStride 4
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpDecorate %b DescriptorSet 0
OpDecorate %b Binding 0
%void = OpTypeVoid
%bool = OpTypeBool
%signature = OpTypeFunction %void
%uint = OpTypeInt 32 0
%zero = OpConstant %uint 0
%one = OpConstant %uint 1
%two = OpConstant %uint 2
%four = OpConstant %uint 4
%five = OpConstant %uint 5
%sixteen = OpConstant %uint 16
%semantics = OpConstant %uint 264
%input = OpTypePointer Input %uint
%index = OpVariable %input Input
%array = OpTypeRuntimeArray %uint
%block = OpTypeStruct %array
%buffer = OpTypePointer StorageBuffer %block
%b = OpVariable %buffer StorageBuffer
%element = OpTypePointer StorageBuffer %uint
%shared_array = OpTypeArray %uint %sixteen
%shared_pointer = OpTypePointer Workgroup %shared_array
%left = OpVariable %shared_pointer Workgroup
%right = OpVariable %shared_pointer Workgroup
%lone = OpTypePointer Workgroup %uint
%single = OpVariable %lone Workgroup
%holder = OpTypePointer Function %lone
%picker = OpTypeFunction %lone %lone %bool
%main = OpFunction %void None %signature
%entry = OpLabel
%held = OpVariable %holder Function
%i = OpLoad %uint %index
%odd = OpBitwiseAnd %uint %i %one
%is_odd = OpIEqual %bool %odd %one
%which = OpSelect %shared_pointer %is_odd %left %right
%own = OpAccessChain %lone %which %i
OpStore %held %own
%again = OpLoad %lone %held
OpStore %again %i
OpControlBarrier %two %two %semantics
OpBranch %head
%head = OpLabel
%k = OpPhi %uint %zero %entry %k_next %next
%walk = OpPhi %lone %single %entry %ahead %next
%more = OpULessThan %bool %k %five
OpLoopMerge %done %next None
OpBranchConditional %more %next %done
%next = OpLabel
%before = OpAtomicIAdd %uint %walk %two %zero %one
%k_next = OpIAdd %uint %k %one
%ahead = OpAccessChain %lone %left %k
OpBranch %head
%done = OpLabel
%ahead_of_all = OpAccessChain %lone %left %four
%same = OpPtrEqual %bool %walk %ahead_of_all
%same_word = OpSelect %uint %same %one %zero
OpControlBarrier %two %two %semantics
%chosen = OpFunctionCall %lone %pick %own %is_odd
%read = OpLoad %uint %chosen
%sum = OpIAdd %uint %read %same_word
%place = OpAccessChain %element %b %zero %i
OpStore %place %sum
OpReturn
OpFunctionEnd
%pick = OpFunction %lone None %picker
%first = OpFunctionParameter %lone
%yes = OpFunctionParameter %bool
%pick_entry = OpLabel
OpSelectionMerge %pick_end None
OpBranchConditional %yes %pick_own %pick_single
%pick_own = OpLabel
OpReturnValue %first
%pick_single = OpLabel
OpReturnValue %single
%pick_end = OpLabel
OpUnreachable
OpFunctionEnd
)");
  const Words words = run(*device_with(8), spirv, Words(16));
  // Each invocation adds 1 to `single` and to the first four of `left`.
  for (std::uint32_t i = 0; i < 16; ++i) CHECK(words[i] == (i % 2 == 0 ? 16 : i < 4 ? i + 16 : i) + 1);
}

TEST_CASE("rotations") {
  const Words spirv = tandem::test::assembled(R"(
OpCapability Shader
OpCapability GroupNonUniform
OpCapability GroupNonUniformRotateKHR
OpExtension "SPV_KHR_subgroup_rotate"
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %index %b
OpExecutionMode %main LocalSize 16 1 1
OpDecorate %index BuiltIn LocalInvocationIndex
OpDecorate %array ArrayStride 4
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpDecorate %b DescriptorSet 0
OpDecorate %b Binding 0
%void = OpTypeVoid
%signature = OpTypeFunction %void
%uint = OpTypeInt 32 0
%zero = OpConstant %uint 0
%three = OpConstant %uint 3
%four = OpConstant %uint 4
%input = OpTypePointer Input %uint
%index = OpVariable %input Input
%array = OpTypeRuntimeArray %uint
%block = OpTypeStruct %array
%buffer = OpTypePointer StorageBuffer %block
%b = OpVariable %buffer StorageBuffer
%element = OpTypePointer StorageBuffer %uint
%hundred = OpConstant %uint 100
%main = OpFunction %void None %signature
%entry = OpLabel
%i = OpLoad %uint %index
%all = OpGroupNonUniformRotateKHR %uint %three %i %three
%part = OpGroupNonUniformRotateKHR %uint %three %i %three %four
%scaled = OpIMul %uint %part %hundred
%sum = OpIAdd %uint %all %scaled
%place = OpAccessChain %element %b %zero %i
OpStore %place %sum
OpReturn
OpFunctionEnd
)");
  const Words words = run(*device_with(8), spirv, Words(16));
  for (std::uint32_t i = 0; i < 16; ++i) CHECK(words[i] == (i / 8 * 8 + (i + 3) % 8) + 100 * (i / 4 * 4 + (i + 3) % 4));
}

}  // namespace
}  // namespace tandem::cpu::test
