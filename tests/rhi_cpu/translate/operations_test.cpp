// What the tables of the translator promise: an instruction is supported exactly if there is C++ for it.

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <spirv-tools/libspirv.hpp>

#include "rhi/error.hpp"
#include "rhi/spirv/names.hpp"
#include "rhi_cpu/translate/instructions/extended_instructions.hpp"
#include "rhi_cpu/translate/instructions/operations.hpp"
#include "rhi_cpu/translate/supported.hpp"
#include "rhi_cpu/translate/translate.hpp"

namespace {

using tandem::cpu::Operation;
using tandem::cpu::Shape;

/// A result type and operands that an instruction may have; the names are those of module_with().
struct Signature {
  const char* result;  ///< "": none
  const char* operands;
};

constexpr Signature signatures[] = {
    // of one operand
    {"float", "%f"},
    {"int", "%i"},
    {"uint", "%u"},
    {"bool", "%b"},
    {"bool", "%b2"},
    {"bool", "%f"},
    {"mat2", "%m"},
    {"int", "%f"},
    {"uint", "%f"},
    {"float", "%i"},
    {"float", "%u"},
    {"double", "%f"},
    {"int", "%l"},
    {"uint", "%ul"},
    {"scene_type", "%ul"},
    // of two
    {"float", "%f %f"},
    {"int", "%i %i"},
    {"uint", "%u %u"},
    {"bool", "%b %b"},
    {"bool", "%i %i"},
    {"bool", "%u %u"},
    {"bool", "%f %f"},
    {"bvec2", "%b2 %b2"},
    {"bvec2", "%i2 %i2"},
    {"bvec2", "%u2 %u2"},
    {"bvec2", "%f2 %f2"},
    {"vec2", "%f2 %f"},
    {"mat2", "%m %f"},
    {"vec2", "%f2 %m"},
    {"vec2", "%m %f2"},
    {"mat2", "%m %m"},
    {"mat2", "%f2 %f2"},
    {"float", "%f2 %f2"},
    {"uint_pair", "%u %u"},
    {"int_pair", "%i %i"},
    // of more
    {"float", "%b %f %f"},
    {"int", "%i %i %i %i"},
    {"int", "%i %i %i"},
    {"uint", "%u %u %u"},
    // atomics: pointer, scope, semantics, value
    {"uint", "%uint_place %scope %relaxed"},
    {"uint", "%uint_place %scope %relaxed %u"},
    {"float", "%float_place %scope %relaxed %f"},
    // ray queries
    {"", "%query %scene %u %u %f3 %f %f3 %f"},
    {"", "%query"},
    {"", "%query %f"},
    {"bool", "%query"},
    {"float", "%query"},
    {"uint", "%query"},
    {"vec3", "%query"},
    {"bool", "%query %u"},
    {"float", "%query %u"},
    {"int", "%query %u"},
    {"uint", "%query %u"},
    {"vec2", "%query %u"},
    {"vec3", "%query %u"},
    {"mat4x3", "%query %u"},
};

/// A module whose shader executes `instruction`, which may use the values that are declared here.
std::string module_with(const std::string& instruction) {
  return R"(OpCapability Shader
OpCapability Float64
OpCapability Int64
OpCapability RayQueryKHR
OpCapability AtomicFloat32AddEXT
OpCapability AtomicFloat32MinMaxEXT
OpExtension "SPV_KHR_ray_query"
OpExtension "SPV_EXT_shader_atomic_float_add"
OpExtension "SPV_EXT_shader_atomic_float_min_max"
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %buffer %scene_place
OpExecutionMode %main LocalSize 1 1 1
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpMemberDecorate %block 1 Offset 4
OpDecorate %buffer DescriptorSet 0
OpDecorate %buffer Binding 0
OpDecorate %scene_place DescriptorSet 0
OpDecorate %scene_place Binding 1
%void = OpTypeVoid
%signature = OpTypeFunction %void
%bool = OpTypeBool
%int = OpTypeInt 32 1
%uint = OpTypeInt 32 0
%long = OpTypeInt 64 1
%ulong = OpTypeInt 64 0
%float = OpTypeFloat 32
%double = OpTypeFloat 64
%bvec2 = OpTypeVector %bool 2
%ivec2 = OpTypeVector %int 2
%uvec2 = OpTypeVector %uint 2
%vec2 = OpTypeVector %float 2
%vec3 = OpTypeVector %float 3
%mat2 = OpTypeMatrix %vec2 2
%mat4x3 = OpTypeMatrix %vec3 4
%int_pair = OpTypeStruct %int %int
%uint_pair = OpTypeStruct %uint %uint
%scene_type = OpTypeAccelerationStructureKHR
%query_type = OpTypeRayQueryKHR
%block = OpTypeStruct %uint %float
%block_pointer = OpTypePointer StorageBuffer %block
%uint_pointer = OpTypePointer StorageBuffer %uint
%float_pointer = OpTypePointer StorageBuffer %float
%scene_pointer = OpTypePointer UniformConstant %scene_type
%query_pointer = OpTypePointer Function %query_type
%b = OpConstantTrue %bool
%i = OpConstant %int 1
%u = OpConstant %uint 1
%zero = OpConstant %uint 0
%scope = OpConstant %uint 1
%relaxed = OpConstant %uint 0
%l = OpConstant %long 1
%ul = OpConstant %ulong 1
%f = OpConstant %float 1
%b2 = OpConstantComposite %bvec2 %b %b
%i2 = OpConstantComposite %ivec2 %i %i
%u2 = OpConstantComposite %uvec2 %u %u
%f2 = OpConstantComposite %vec2 %f %f
%f3 = OpConstantComposite %vec3 %f %f %f
%m = OpConstantComposite %mat2 %f2 %f2
%buffer = OpVariable %block_pointer StorageBuffer
%scene_place = OpVariable %scene_pointer UniformConstant
%main = OpFunction %void None %signature
%entry = OpLabel
%query = OpVariable %query_pointer Function
%scene = OpLoad %scene_type %scene_place
%uint_place = OpAccessChain %uint_pointer %buffer %zero
%float_place = OpAccessChain %float_pointer %buffer %u
)" + instruction +
         "\nOpReturn\nOpFunctionEnd\n";
}

std::string instruction_text(const Operation& operation, const Signature& signature) {
  const std::string name = std::string("Op") + spvOpcodeString(static_cast<std::uint32_t>(operation.op));
  if (*signature.result == '\0') return name + " " + signature.operands;
  return "%result = " + name + " %" + signature.result + " " + signature.operands;
}

/// The words, if SPIR-V allows the instruction to be so.
std::optional<std::vector<std::uint32_t>> assembled(const std::string& instruction) {
  const spvtools::SpirvTools tools(SPV_ENV_UNIVERSAL_1_6);
  std::vector<std::uint32_t> words;
  if (!tools.Assemble(module_with(instruction), &words) || !tools.Validate(words)) return std::nullopt;
  return words;
}

/// What the C++ of the operation has in it.
std::string expected_text(const Operation& operation, bool result_is_vector) {
  const std::string text = operation.text;
  switch (operation.shape) {
    case Shape::infix:
      return " " + text + " ";
    case Shape::prefix:
      return " = " + text;
    case Shape::relation:
      return result_is_vector ? std::string("k::") + operation.function + "(" : " " + text + " ";
    case Shape::conversion:
      return "k::" + text + "<";
    case Shape::double_width:
      return std::string("k::") + operation.function + "(";
    case Shape::atomic:
      return "k::atomic_" + text + "<";
    case Shape::ray_query_getter:
      return "k::rayQueryGet" + text + "EXT(";
    case Shape::call:
    case Shape::shift:
    case Shape::bit_field:
    case Shape::statement:
      return "k::" + text + "(";
  }
  return "?";
}

/// The lines of `source` that `without` does not have.
std::string lines_beside(const std::string& without, const std::string& source) {
  const auto lines = [](const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> result;
    for (std::string line; std::getline(stream, line);) result.push_back(line);
    return result;
  };
  const std::vector<std::string> known = lines(without);
  std::string own;
  for (const std::string& line : lines(source))
    if (std::find(known.begin(), known.end(), line) == known.end()) own += line + "\n";
  return own;
}

TEST_CASE("every operation of the table is printed as it says") {
  REQUIRE(assembled("OpNop"));
  const std::string without = tandem::cpu::translate(*assembled("OpNop"), "without").source;
  for (const Operation& operation : tandem::cpu::operations) {
    std::uint32_t allowed = 0;
    for (const Signature& signature : signatures) {
      const std::string instruction = instruction_text(operation, signature);
      const auto words = assembled(instruction);
      if (!words) continue;
      CAPTURE(instruction);
      ++allowed;
      const std::string source = tandem::cpu::translate(*words, "with").source;
      const std::string own = lines_beside(without, source);
      CAPTURE(own);
      CHECK(own.find(expected_text(operation, *signature.result == 'b' && signature.result != std::string("bool"))) !=
            std::string::npos);
    }
    CAPTURE(spvOpcodeString(static_cast<std::uint32_t>(operation.op)));
    CHECK_MESSAGE(allowed > 0, "the test has no operands for this instruction");
  }
}

TEST_CASE("every operation of the table is supported, once") {
  for (const Operation& operation : tandem::cpu::operations) {
    CAPTURE(spvOpcodeString(static_cast<std::uint32_t>(operation.op)));
    CHECK(tandem::cpu::is_supported(operation.op));
    CHECK(tandem::cpu::find_operation(operation.op) == &operation);
  }
  for (const tandem::cpu::ExtendedInstruction& extended : tandem::cpu::extended_instructions) {
    CAPTURE(extended.function);
    CHECK(tandem::cpu::find_extended(extended.instruction) == &extended);
  }
}

TEST_CASE("an instruction is refused exactly if nothing prints it") {
  constexpr std::uint32_t beyond_all_opcodes = 7000;
  std::uint32_t supported = 0;
  for (std::uint32_t opcode = 0; opcode < beyond_all_opcodes; ++opcode) {
    const auto op = static_cast<spv::Op>(opcode);
    // Alone and without operands: what reads them may refuse them, but not as an instruction.
    const std::vector<std::uint32_t> words = {spv::MagicNumber, 0x00010600, 0, 10, 0, 1u << 16 | opcode};
    std::string error;
    try {
      tandem::cpu::check_supported(words, "a label");
    } catch (const tandem::rhi::Error& refusal) {
      error = refusal.what();
    }
    const bool refused =
        error == "a label: " + tandem::rhi::instruction_name(op, {}) + " is not supported by the CPU device";
    if (refused == tandem::cpu::is_supported(op)) {
      CAPTURE(opcode);
      CAPTURE(error);
      FAIL_CHECK("supported and refused, or neither");
    }
    supported += tandem::cpu::is_supported(op);
  }
  CHECK(supported > std::size(tandem::cpu::operations));
}

}  // namespace
