#include <doctest/doctest.h>

#include <spirv-tools/libspirv.hpp>

#include <string>
#include <vector>

#include "tests/rhi/dispatch.hpp"

using namespace tandem;

namespace {

/// Two compute shaders and a fragment shader over one buffer: `twice` doubles, `thrice` triples.
std::vector<std::uint32_t> module_of_three() {
  const spvtools::SpirvTools tools(SPV_ENV_UNIVERSAL_1_5);
  std::vector<std::uint32_t> words;
  const auto entry = [](const std::string& name, const std::string& factor) {
    return "%" + name + " = OpFunction %void None %signature\n%" + name + "_label = OpLabel\n%" + name +
           "_at = OpAccessChain %pointer %block %zero\n%" + name + "_old = OpLoad %uint %" + name + "_at\n%" + name +
           "_new = OpIMul %uint %" + name + "_old %" + factor + "\nOpStore %" + name + "_at %" + name +
           "_new\nOpReturn\nOpFunctionEnd\n";
  };
  REQUIRE(tools.Assemble(R"(
OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %twice "twice" %block
OpEntryPoint GLCompute %thrice "thrice" %block
OpEntryPoint Fragment %pixel "pixel"
OpExecutionMode %twice LocalSize 1 1 1
OpExecutionMode %thrice LocalSize 2 1 1
OpExecutionMode %pixel OriginUpperLeft
OpDecorate %struct Block
OpMemberDecorate %struct 0 Offset 0
OpDecorate %block DescriptorSet 0
OpDecorate %block Binding 0
%void = OpTypeVoid
%signature = OpTypeFunction %void
%uint = OpTypeInt 32 0
%zero = OpConstant %uint 0
%two = OpConstant %uint 2
%three = OpConstant %uint 3
%struct = OpTypeStruct %uint
%to_struct = OpTypePointer StorageBuffer %struct
%pointer = OpTypePointer StorageBuffer %uint
%block = OpVariable %to_struct StorageBuffer
)" + entry("twice", "two") + entry("thrice", "three") +
                             "%pixel = OpFunction %void None %signature\n%pixel_label = OpLabel\nOpKill\n"
                             "OpFunctionEnd\n",
                         &words));
  return words;
}

}  // namespace

TANDEM_DEVICE_TEST("of a module with several entry points one is chosen by name") {
  const std::vector<std::uint32_t> words = module_of_three();
  const auto module = [&](const std::string& name) {
    return device.create_shader_module({.spirv = words, .label = "three", .entry_point = name});
  };
  const rhi::BufferHandle number = test::buffer_of(device, std::vector<std::uint32_t>{7}, "number");
  test::run(device, device.create_compute_pipeline({.shader = module("twice"), .specialization = {}, .label = "twice"}),
            {number});
  CHECK(test::contents<std::uint32_t>(device, number, 1)[0] == 14);
  CHECK(module("thrice")->reflection().workgroup_size[0] == 2);
  CHECK(module("thrice")->reflection().entry_point == "thrice");
  CHECK_ERROR(invalid_argument,
              "three: the SPIR-V module has several entry points, of which one must be named: twice, "
              "thrice, pixel",
              module(""));
  CHECK_ERROR(invalid_argument, "has no entry point 'once', but twice, thrice, pixel", module("once"));
  CHECK_ERROR(unsupported, "neither compute nor a ray tracing stage", module("pixel"));
}

TANDEM_DEVICE_TEST("every reason why a shader cannot run is told, and none where it can") {
  const std::vector<std::uint32_t> words = module_of_three();
  CHECK(
      device.refusals(device.create_shader_module({.spirv = words, .label = "three", .entry_point = "twice"})).empty());
  std::vector<std::uint32_t> odd = words;
  // After the first capability, two that no device of ours has.
  constexpr std::uint32_t tessellation = 3, geometry = 2;
  odd.insert(odd.begin() + 7, {2u << 16 | 17u, tessellation, 2u << 16 | 17u, geometry});
  const std::vector<std::string> reasons = device.refusals(
      device.create_shader_module({.spirv = odd, .label = "odd", .known_valid = true, .entry_point = "twice"}));
  REQUIRE(reasons.size() == 2);
  CHECK((reasons[0].find("Tessellation") != std::string::npos || reasons[0].find("capability 3") != std::string::npos));
  CHECK((reasons[1].find("Geometry") != std::string::npos || reasons[1].find("capability 2") != std::string::npos));
}

TANDEM_DEVICE_TEST("an array of descriptors cannot be sized by a constant that a pipeline may set") {
  CHECK_ERROR(unsupported, "B has a specialisation constant as its length",
              test::compute_pipeline(device, R"(#version 460
layout(local_size_x = 1) in;
layout(constant_id = 0) const int N = 2;
layout(binding = 0) buffer B { float b[]; } t[N];
void main() { t[0].b[0] = 1; }
)",
                                     "sized"));
}
