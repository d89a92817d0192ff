#include "program/record/module.hpp"

#include <algorithm>

#include <spirv-tools/libspirv.h>
#include <spirv-tools/optimizer.hpp>

#include "rhi/error.hpp"

namespace tandem::program {
namespace {

bool is_preamble(spv::Op op) {
  switch (op) {
    case spv::OpCapability:
    case spv::OpExtension:
    case spv::OpExtInstImport:
    case spv::OpMemoryModel:
    case spv::OpEntryPoint:
    case spv::OpExecutionMode:
    case spv::OpExecutionModeId:
    case spv::OpString:
    case spv::OpSourceExtension:
    case spv::OpSource:
    case spv::OpSourceContinued:
    case spv::OpName:
    case spv::OpMemberName:
    case spv::OpModuleProcessed:
    case spv::OpDecorate:
    case spv::OpMemberDecorate:
    case spv::OpDecorationGroup:
    case spv::OpGroupDecorate:
    case spv::OpGroupMemberDecorate:
    case spv::OpDecorateId:
    case spv::OpDecorateString:
    case spv::OpMemberDecorateString:
      return true;
    default:
      return false;
  }
}

bool is_used_id(spv_operand_type_t type) {
  return type == SPV_OPERAND_TYPE_ID || type == SPV_OPERAND_TYPE_SCOPE_ID ||
         type == SPV_OPERAND_TYPE_MEMORY_SEMANTICS_ID;
}

std::string text_at(const std::vector<std::uint32_t>& words, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < words.size(); ++i)
    for (unsigned shift = 0; shift < 32; shift += 8) {
      const char c = static_cast<char>(words[i] >> shift);
      if (c == '\0') return text;
      text.push_back(c);
    }
  return text;
}

spv_result_t read_header(void* data, spv_endianness_t, std::uint32_t magic, std::uint32_t version,
                         std::uint32_t generator, std::uint32_t bound, std::uint32_t schema) {
  static_cast<Module*>(data)->header = {magic, version, generator, bound, schema};
  return SPV_SUCCESS;
}

spv_result_t read_instruction(void* data, const spv_parsed_instruction_t* parsed) {
  Instruction read{.op = static_cast<spv::Op>(parsed->opcode),
                   .words = {parsed->words, parsed->words + parsed->num_words},
                   .type = parsed->type_id,
                   .result = parsed->result_id};
  for (const spv_parsed_operand_t& operand : std::span(parsed->operands, parsed->num_operands))
    if (is_used_id(operand.type)) read.used_ids.push_back(operand.offset);
  static_cast<Module*>(data)->instructions.push_back(std::move(read));
  return SPV_SUCCESS;
}

/// OpLine holds up to the next one, OpNoLine, or the end of the block.
void place_lines(Module& module) {
  SourceLine line;
  for (Instruction& instruction : module.instructions) {
    const std::vector<std::uint32_t>& words = instruction.words;
    if (instruction.op == spv::OpLine) line = {words[1], words[2], words[3]};
    if (instruction.op == spv::OpNoLine || instruction.op == spv::OpFunctionEnd) line = {};
    instruction.line = line;
    if (instruction.op == spv::OpLabel) line = {};
  }
}

}  // namespace

Module parse_module(std::span<const std::uint32_t> spirv, std::string_view label) {
  Module module;
  const spv_context context = spvContextCreate(SPV_ENV_UNIVERSAL_1_6);
  spv_diagnostic diagnostic = nullptr;
  const spv_result_t result =
      spvBinaryParse(context, &module, spirv.data(), spirv.size(), read_header, read_instruction, &diagnostic);
  const std::string message = diagnostic != nullptr ? diagnostic->error : "";
  spvDiagnosticDestroy(diagnostic);
  spvContextDestroy(context);
  if (result != SPV_SUCCESS)
    throw rhi::Error(rhi::ErrorCode::unsupported, label, "the SPIR-V cannot be read: " + message);
  place_lines(module);
  const auto begin = module.instructions.begin(), end = module.instructions.end();
  const auto index = [&](auto found) { return static_cast<std::size_t>(found - begin); };
  module.first_global = index(std::find_if_not(begin, end, [](const Instruction& i) { return is_preamble(i.op); }));
  module.first_function = index(std::find_if(begin, end, [](const Instruction& i) { return i.op == spv::OpFunction; }));
  for (std::size_t i = 0; i < module.instructions.size(); ++i) {
    const Instruction& instruction = module.instructions[i];
    if (instruction.result != 0) module.definitions.emplace(instruction.result, i);
    if (instruction.op == spv::OpName)
      module.names.insert_or_assign(instruction.words[1], text_at(instruction.words, 2));
  }
  return module;
}

const Instruction& definition(const Module& module, std::uint32_t id) {
  return module.instructions[module.definitions.at(id)];
}

std::string string_of(const Module& module, std::uint32_t id) {
  const auto found = module.definitions.find(id);
  if (found == module.definitions.end()) return "";
  const Instruction& instruction = module.instructions[found->second];
  return instruction.op == spv::OpString ? text_at(instruction.words, 2) : "";
}

std::vector<std::uint32_t> with_fixed_constants(
    std::span<const std::uint32_t> spirv, const std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>& values,
    std::string_view label) {
  spvtools::Optimizer optimizer(SPV_ENV_UNIVERSAL_1_6);
  optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
      .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
      .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass());
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);
  options.set_preserve_bindings(true);
  std::vector<std::uint32_t> words;
  if (!optimizer.Run(spirv.data(), spirv.size(), &words, options))
    throw rhi::Error(rhi::ErrorCode::unsupported, label, "its specialisation constants cannot be replaced");
  return words;
}

}  // namespace tandem::program
