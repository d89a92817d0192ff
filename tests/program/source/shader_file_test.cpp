#include "program/source/shader_file.hpp"

#include <doctest/doctest.h>

#include <string>
#include <string_view>

#include "base/error.hpp"
#include "rhi/error.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

constexpr const char* text = R"(#version 460
#include "size.glsl"
layout(local_size_x = SIZE) in;
layout(binding = 0) buffer Words { uint words[]; };
void main() { words[gl_GlobalInvocationID.x] = MORE; }
)";

/// What spirv-dis would write of a shader that does nothing.
constexpr const char* assembly = R"(; SPIR-V
; Version: 1.3
               OpCapability Shader
               OpMemoryModel Logical GLSL450
               OpEntryPoint GLCompute %first "first"
               OpEntryPoint GLCompute %second "second"
               OpExecutionMode %first LocalSize 4 1 1
               OpExecutionMode %second LocalSize 8 1 1
       %void = OpTypeVoid
   %function = OpTypeFunction %void
      %first = OpFunction %void None %function
          %1 = OpLabel
               OpReturn
               OpFunctionEnd
     %second = OpFunction %void None %function
          %2 = OpLabel
               OpReturn
               OpFunctionEnd
)";

std::string refusal(const std::filesystem::path& path, const std::string& entry_point = "") {
  try {
    load_shader(path, {}, entry_point);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("GLSL is compiled with its macros and includes, for the stage of its name") {
  const test::ScratchFolder folder;
  folder.write("size.glsl", "#define SIZE 8\n");
  const auto path = folder.write("a.comp", text);
  const Shader shader = load_shader(path, {.defines = {{"MORE", "7"}}});
  CHECK(shader.stage == rhi::ShaderStage::compute);
  CHECK(shader.name == path.string());
  CHECK(rhi::reflect(shader.spirv, "a").workgroup_size[0] == 8);
  CHECK(refusal(path).find("MORE") != std::string::npos);
}

TEST_CASE("SPIR-V is read as words and as text, of the version that the text names") {
  const test::ScratchFolder folder;
  const auto path = folder.write("a.spvasm", assembly);
  const Shader shader = load_shader(path, {}, "second");
  CHECK(shader.spirv[1] == 0x00010300);
  CHECK(shader.entry_point == "second");
  CHECK(refusal(path).find("entry point") != std::string::npos);
  const std::string_view bytes(reinterpret_cast<const char*>(shader.spirv.data()), shader.spirv.size() * 4);
  CHECK(load_shader(folder.write("a.spv", bytes), {}, "first").spirv == shader.spirv);
  CHECK(load_shader(folder.write("b.spvasm", std::string(assembly).substr(23)), {}, "first").spirv[1] == 0x00010500);
}

TEST_CASE("what is no shader is refused by name") {
  const test::ScratchFolder folder;
  CHECK(refusal(folder.write("a.frag", "void main() {}")).find("a.frag' is no shader: GLSL ends in") !=
        std::string::npos);
  CHECK(refusal(folder.write("a.spv", "12345")).find("a.spv': it has 5 bytes") != std::string::npos);
  CHECK(refusal(folder.write("b.spv", "12345678")).find("b.spv") != std::string::npos);
  CHECK(refusal(folder.write("a.spvasm", "OpCapability Nonsense")).find("a.spvasm: line 1: ") != std::string::npos);
  CHECK(refusal(folder.path() / "missing.comp").find("missing.comp") != std::string::npos);
}

}  // namespace
