// Values that are made in the body of a loop and used behind it.

#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/kernel/images.hpp"
#include "tests/rhi_cpu/translate/assembly.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

namespace kernel = tandem::kernel;
using tandem::test::assembled;
using tandem::test::Kernel;
using tandem::test::KernelOptions;
using tandem::test::resource;

/// `inside` is the body of a loop of two iterations, in which %i counts; `after` follows it.
std::string module(const std::string& capabilities, const std::string& interface, const std::string& decorations,
                   const std::string& globals, const std::string& inside, const std::string& after) {
  const bool is_physical = capabilities.find("Physical") != std::string::npos;
  return "OpCapability Shader\nOpCapability Int64\n" + capabilities + "\nOpMemoryModel " +
         (is_physical ? "PhysicalStorageBuffer64" : "Logical") + " GLSL450\nOpEntryPoint GLCompute %main \"main\" " +
         interface + R"( %buffer
OpExecutionMode %main LocalSize 1 1 1
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpMemberDecorate %block 1 Offset 8
OpDecorate %buffer DescriptorSet 0
OpDecorate %buffer Binding 0
)" + decorations +
         R"(
%void = OpTypeVoid
%signature = OpTypeFunction %void
%bool = OpTypeBool
%uint = OpTypeInt 32 0
%ulong = OpTypeInt 64 0
%float = OpTypeFloat 32
%zero = OpConstant %uint 0
%one = OpConstant %uint 1
%block = OpTypeStruct %ulong %uint
%pointer = OpTypePointer StorageBuffer %block
%ulong_pointer = OpTypePointer StorageBuffer %ulong
%uint_pointer = OpTypePointer StorageBuffer %uint
%buffer = OpVariable %pointer StorageBuffer
)" + globals +
         R"(
%main = OpFunction %void None %signature
%entry = OpLabel
OpBranch %header
%header = OpLabel
%i = OpPhi %uint %zero %entry %next %continue
OpLoopMerge %done %continue None
OpBranch %inside
%inside = OpLabel
)" + inside +
         R"(
%enough = OpUGreaterThanEqual %bool %i %one
OpBranchConditional %enough %done %continue
%continue = OpLabel
%next = OpIAdd %uint %i %one
OpBranch %header
%done = OpLabel
)" + after +
         R"(
%place = OpAccessChain %uint_pointer %buffer %one
OpStore %place %result
OpReturn
OpFunctionEnd
)";
}

struct Memory {
  std::uint64_t number = 0;
  std::uint32_t result = 0;
  std::uint32_t unused = 0;
};

TEST_CASE("a pointer that is loaded in a loop is followed behind it") {
  const std::string text =
      module("OpCapability PhysicalStorageBufferAddresses", "", "OpDecorate %physical ArrayStride 4\n",
             "%physical = OpTypePointer PhysicalStorageBuffer %uint\n",
             "%number_place = OpAccessChain %ulong_pointer %buffer %zero\n"
             "%number = OpLoad %ulong %number_place\n"
             "%address = OpConvertUToPtr %physical %number\n",
             "%second = OpPtrAccessChain %physical %address %one\n"
             "%result = OpLoad %uint %second Aligned 4\n");
  for (const bool optimize : {false, true}) {
    KernelOptions options;
    options.optimize = optimize;
    std::uint32_t target[2] = {321, 654};
    std::vector<Memory> memory = {{.number = reinterpret_cast<std::uintptr_t>(target)}};
    Kernel(assembled(text), options).run({resource(memory)});
    CHECK(memory[0].result == 654);
  }
}

TEST_CASE("an image that is loaded in a loop is read behind it") {
  const std::string text =
      module("", "%images", "OpDecorate %images DescriptorSet 0\nOpDecorate %images Binding 1\n",
             "%image = OpTypeImage %uint 2D 0 0 0 2 R32ui\n%two = OpConstant %uint 2\n"
             "%array = OpTypeArray %image %two\n%array_pointer = OpTypePointer UniformConstant %array\n"
             "%image_pointer = OpTypePointer UniformConstant %image\n"
             "%images = OpVariable %array_pointer UniformConstant\n%uvec2 = OpTypeVector %uint 2\n"
             "%uvec4 = OpTypeVector %uint 4\n%origin = OpConstantComposite %uvec2 %zero %zero\n",
             "%image_place = OpAccessChain %image_pointer %images %i\n%loaded = OpLoad %image %image_place\n",
             "%texel = OpImageRead %uvec4 %loaded %origin\n%result = OpCompositeExtract %uint %texel 0\n");
  std::uint32_t texels[2] = {11, 22};
  kernel::Image images[2];
  for (int k = 0; k < 2; ++k) {
    images[k].texels = reinterpret_cast<std::byte*>(&texels[k]);
    images[k].format = static_cast<std::uint32_t>(kernel::TexelFormat::r32_uint);
  }
  std::vector<Memory> memory(1);
  Kernel(assembled(text), {})
      .run({resource(memory),
            {reinterpret_cast<std::byte*>(&images[0]), 0},
            {reinterpret_cast<std::byte*>(&images[1]), 0}});
  CHECK(memory[0].result == 22);
}

}  // namespace
