// Everything that the translator does not handle is named.

#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <spirv-tools/libspirv.hpp>

#include "rhi/error.hpp"
#include "rhi_cpu/translate/translate.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::rhi::Error;
using tandem::rhi::ErrorCode;

std::vector<std::uint32_t> assemble(const std::string& text) {
  const spvtools::SpirvTools tools(SPV_ENV_UNIVERSAL_1_6);
  std::vector<std::uint32_t> words;
  REQUIRE(tools.Assemble(text, &words, SPV_TEXT_TO_BINARY_OPTION_PRESERVE_NUMERIC_IDS));
  return words;
}

void check_refused(const std::vector<std::uint32_t>& spirv, ErrorCode code, const std::string& what) {
  CAPTURE(what);
  try {
    tandem::cpu::translate(spirv, "a label");
    FAIL_CHECK("translated");
  } catch (const Error& error) {
    CAPTURE(std::string(error.what()));
    CHECK(error.code() == code);
    CHECK(std::string(error.what()).find("a label: ") == 0);
    CHECK(std::string(error.what()).find(what) != std::string::npos);
  }
}

void check_glsl(const std::string& glsl, const std::string& what) {
  check_refused(tandem::test::compute_spirv("layout(local_size_x = 4) in;\n" + glsl), ErrorCode::unsupported, what);
}

/// A module that does nothing, with more in its preamble, its decorations, its globals and its body.
std::string module(const std::string& capability, const std::string& decorations, const std::string& globals,
                   const std::string& body, const std::string& model = "GLCompute") {
  return "OpCapability Shader\n" + capability +
         "%glsl = OpExtInstImport \"GLSL.std.450\"\nOpMemoryModel Logical GLSL450\n" + "OpEntryPoint " + model +
         " %main \"main\"\n" + (model == "GLCompute" ? "OpExecutionMode %main LocalSize 1 1 1\n" : "") + decorations +
         "%void = OpTypeVoid\n%signature = OpTypeFunction %void\n%float = OpTypeFloat 32\n%one = OpConstant %float "
         "1\n" +
         globals + "%main = OpFunction %void None %signature\n%entry = OpLabel\n" + body + "OpReturn\nOpFunctionEnd\n";
}

TEST_CASE("the empty module is supported") { tandem::cpu::translate(assemble(module("", "", "", "")), "empty"); }

TEST_CASE("GLSL features are refused by what they are in SPIR-V") {
  check_glsl("layout(binding = 0, rgba8) uniform image2DMS i; void main() { imageStore(i, ivec2(0), 0, vec4(0)); }",
             "capability StorageImageMultisample and OpTypeImage with several samples are not supported");
  check_glsl(
      "layout(binding = 0) uniform sampler2DMS s; layout(binding = 1) buffer B { vec4 b; };\n"
      "void main() { b = texelFetch(s, ivec2(0), 1); }",
      "OpTypeImage with several samples is not supported");
  check_glsl("shared int s[20000]; void main() { s[gl_LocalInvocationIndex] = 1; }",
             "its shared variables have 80000 bytes, where a workgroup on the CPU device has 65536");
  check_glsl(
      "#extension GL_NV_shader_subgroup_partitioned : require\nlayout(binding = 1) buffer B { uint b; };\n"
      "void main() { b = subgroupPartitionNV(b).x; }",
      "capability GroupNonUniformPartitionedNV and OpGroupNonUniformPartitionNV are not supported");
  check_refused(tandem::test::traced_spirv("#extension GL_KHR_shader_subgroup_basic : require\n"
                                           "layout(location = 0) rayPayloadInEXT uint p;\n"
                                           "void main() { p = gl_SubgroupSize; }",
                                           tandem::rhi::ShaderStage::miss),
                ErrorCode::unsupported, "capability GroupNonUniform in a ray tracing stage is not supported");
}

TEST_CASE("what has no level of detail outside of a fragment shader is named") {
  const std::string image =
      "%texel = OpTypeVector %float 4\n%plane = OpTypeVector %float 2\n%image = OpTypeImage %float 2D 0 0 0 1 Unknown\n"
      "%both = OpTypeSampledImage %image\n%pointer = OpTypePointer UniformConstant %both\n"
      "%texture = OpVariable %pointer UniformConstant\n%at = OpConstantComposite %plane %one %one\n";
  const std::string load = "%s = OpLoad %both %texture\n";
  const auto refused = [&](const std::string& instruction, const std::string& what) {
    check_refused(assemble(module("OpCapability ImageQuery\n", "", image, load + instruction)), ErrorCode::unsupported,
                  what);
  };
  refused("%r = OpImageSampleImplicitLod %texel %s %at\n", "OpImageSampleImplicitLod is");
  refused("%r = OpImageSampleImplicitLod %texel %s %at Bias %one\n", "OpImageSampleImplicitLod is");
  refused("%r = OpImageSampleDrefImplicitLod %float %s %at %one\n", "OpImageSampleDrefImplicitLod is");
  refused("%r = OpImageSampleProjImplicitLod %texel %s %at\n", "OpImageSampleProjImplicitLod is");
  refused("%r = OpImageQueryLod %plane %s %at\n", "OpImageQueryLod is");
  check_refused(assemble(module("OpCapability SampledRect\n", "", "", "")), ErrorCode::unsupported,
                "capability SampledRect is");
  check_refused(assemble(module("", "", "%i = OpTypeImage %float Rect 0 0 0 1 Unknown\n", "")), ErrorCode::unsupported,
                "OpTypeImage of dimension Rect is");
  check_refused(assemble(module("", "", "%i = OpTypeImage %float 2D 0 0 0 0 Unknown\n", "")), ErrorCode::unsupported,
                "OpTypeImage that may be sampled or not is");
  check_refused(assemble(module("", "", "%i = OpTypeImage %float 2D 0 0 1 1 Unknown\n", "")), ErrorCode::unsupported,
                "OpTypeImage with several samples is");
}

TEST_CASE("capabilities, models, modes, storage classes, decorations and built-ins are named") {
  check_refused(assemble(module("OpCapability Geometry\n", "", "", "")), ErrorCode::unsupported,
                "capability Geometry is");
  check_refused(assemble(module("OpCapability Linkage\n", "", "", "")), ErrorCode::unsupported,
                "capability Linkage is");
  check_refused(assemble(module("", "", "", "", "Vertex")), ErrorCode::unsupported, "execution model Vertex is");
  check_refused(assemble(module("", "OpExecutionMode %main DepthReplacing\n", "", "")), ErrorCode::unsupported,
                "execution mode DepthReplacing is");
  check_refused(assemble(module("", "", "%p = OpTypePointer Output %float\n", "")), ErrorCode::unsupported,
                "storage class Output is");
  check_refused(assemble(module("", "OpDecorate %one Flat\n", "", "")), ErrorCode::unsupported, "decoration Flat is");
  check_refused(assemble(module("", "OpDecorate %one Location 3\n", "", "")), ErrorCode::unsupported,
                "decoration Location is");
  check_refused(assemble(module("", "OpDecorate %one Component 3\n", "", "")), ErrorCode::unsupported,
                "decoration Component is");
  check_refused(assemble(module("", "OpExecutionMode %main Invocations 3\n", "", "")), ErrorCode::unsupported,
                "execution mode Invocations is");
  check_refused(assemble(module("", "OpDecorate %one BuiltIn FragCoord\n", "", "")), ErrorCode::unsupported,
                "built-in FragCoord is");
  for (const std::string capability : {"StorageInputOutput16", "RoundingModeRTZ", "DenormFlushToZero", "Addresses"})
    check_refused(assemble(module("OpCapability " + capability + "\n", "", "", "")), ErrorCode::unsupported,
                  "capability " + capability + " is");
  check_refused(assemble(module("", "OpDecorate %one FPRoundingMode RTP\n", "", "")), ErrorCode::unsupported,
                "rounding to an infinity is");
  // Numbers that no grammar has yet.
  std::vector<std::uint32_t> words = assemble(module("OpCapability Geometry\n", "", "", ""));
  words[8] = 6999;
  check_refused(words, ErrorCode::unsupported, "capability 6999 is");
}

TEST_CASE("built-ins of other shader stages are named") {
  const auto refused = [](ErrorCode code, const std::string& model, const std::string& built_in,
                          const std::string& sentence) {
    std::string text = module("OpCapability RayTracingKHR\nOpExtension \"SPV_KHR_ray_tracing\"\n",
                              "OpDecorate %built_in BuiltIn " + built_in + "\n",
                              "%int = OpTypeInt 32 1\n%pointer = OpTypePointer Input %int\n"
                              "%built_in = OpVariable %pointer Input\n",
                              "%value = OpLoad %int %built_in\n", model);
    text.replace(text.find("\"main\""), 6, "\"main\" %built_in");
    check_refused(assemble(text), code, sentence);
  };
  // Vulkan's own rules, which the validator knows. Its versions disagree whether a name ends in KHR or, as before, in
  // NV.
  refused(ErrorCode::invalid_argument, "RayGenerationKHR", "PrimitiveId", "BuiltIn PrimitiveId");
  refused(ErrorCode::invalid_argument, "MissKHR", "InstanceCustomIndexKHR", "BuiltIn InstanceCustomIndex");
  refused(ErrorCode::invalid_argument, "CallableKHR", "IncomingRayFlagsKHR", "BuiltIn IncomingRayFlags");
  refused(ErrorCode::invalid_argument, "GLCompute", "PrimitiveId", "BuiltIn PrimitiveId");
  refused(ErrorCode::unsupported, "IntersectionKHR", "LocalInvocationIndex",
          "a label: built-in LocalInvocationIndex in this shader stage is not supported");
}

TEST_CASE("instructions and extended instructions are named") {
  check_refused(assemble(module("", "", "", "%d = OpDPdx %float %one\n")), ErrorCode::unsupported, "OpDPdx is");
  check_refused(assemble(module("", "", "", "OpKill\n%next = OpLabel\n")), ErrorCode::unsupported, "OpKill is");
  check_refused(assemble(module("", "", "", "OpTerminateInvocation\n%next = OpLabel\n")), ErrorCode::unsupported,
                "OpTerminateInvocation is");
  check_refused(assemble(module("", "", "", "OpCopyMemorySized %one %one %one\n")), ErrorCode::unsupported,
                "OpCopyMemorySized is");
  check_refused(assemble(module("", "", "", "%i = OpExtInst %float %glsl InterpolateAtCentroid %one\n")),
                ErrorCode::unsupported, "extended instruction InterpolateAtCentroid is");
  check_refused(
      assemble(module("", "", "%int = OpTypeInt 32 0\n", "%i = OpExtInst %float %glsl IMix %one %one %one\n")),
      ErrorCode::unsupported, "extended instruction IMix is");
  std::string other = module("", "", "", "");
  other.replace(other.find("GLSL.std.450"), 12, "OpenCL.std");
  check_refused(assemble(other), ErrorCode::unsupported, "extended instruction set OpenCL.std is");
}

TEST_CASE("words that are no module") {
  check_refused({}, ErrorCode::invalid_argument, "not SPIR-V");
  check_refused({1, 2, 3, 4, 5, 6}, ErrorCode::invalid_argument, "not SPIR-V");
  std::vector<std::uint32_t> words = assemble(module("", "", "", ""));
  words.resize(words.size() - 1);
  check_refused(words, ErrorCode::invalid_argument, "not valid");
  words.back() = 0x00400000u | (words.back() & 0xffff);
  check_refused(words, ErrorCode::invalid_argument, "words, where the module has 1 more");
  check_refused(assemble(module("", "", "", "%x = OpFAdd %float %one %void\n")), ErrorCode::invalid_argument,
                "not valid");
}

TEST_CASE("cutting a module short at any word is an error, never a crash") {
  const std::vector<std::uint32_t> words = tandem::test::compute_spirv(
      "layout(local_size_x = 1) in; layout(binding = 0) buffer B { float b[]; };\n"
      "void main() { for (int i = 0; i < b.length(); ++i) b[i] = sqrt(b[i]); }");
  for (std::size_t length = 0; length < words.size(); ++length)
    CHECK_THROWS_AS(tandem::cpu::translate({words.data(), length}, "cut"), Error);
}

TEST_CASE("what a ray tracing stage cannot have is named") {
  check_refused(tandem::test::traced_spirv(
                    "hitAttributeEXT float big[9]; void main() { big[8] = 1.0; reportIntersectionEXT(big[8], 0); }",
                    tandem::rhi::ShaderStage::intersection),
                ErrorCode::unsupported, "a hit attribute of 36 bytes, which is more than 32, is not supported");
}

}  // namespace
