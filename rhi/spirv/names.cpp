#include "rhi/spirv/names.hpp"

#include <cstddef>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <spirv-tools/libspirv.hpp>

namespace tandem::rhi {
namespace {

using Words = std::vector<std::uint32_t>;

// Ids of the instructions that are made up here. The disassembler does not ask what they are.
constexpr std::uint32_t id = 1;
constexpr std::uint32_t other_id = 2;

Words instruction(spv::Op op, const Words& operands) {
  Words words = {static_cast<std::uint32_t>(operands.size() + 1) << 16 | static_cast<std::uint32_t>(op)};
  words.insert(words.end(), operands.begin(), operands.end());
  return words;
}

/// The last line of the disassembly of these instructions, word by word; empty when the disassembler refuses them.
std::vector<std::string> disassembled(std::span<const std::uint32_t> instructions) {
  Words module = {spv::MagicNumber, 0x00010600, 0, 0x00400000, 0};
  module.insert(module.end(), instructions.begin(), instructions.end());
  const spvtools::SpirvTools tools(SPV_ENV_UNIVERSAL_1_6);
  std::string text;
  if (!tools.Disassemble(module, &text, SPV_BINARY_TO_TEXT_OPTION_NO_HEADER)) return {};
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::istringstream line(text.substr(text.rfind('\n') + 1));
  std::vector<std::string> words;
  for (std::string word; line >> word;) words.push_back(word);
  // The result stands in front of the operation.
  if (words.size() > 2 && words[1] == "=") words.erase(words.begin(), words.begin() + 2);
  return words;
}

/// The word at `position` of an instruction's disassembly, the operation being word 0; `number` when there is none.
/// @param before instructions that it needs
std::string word(spv::Op op, Words operands, std::size_t position, std::uint32_t number, const Words& before = {}) {
  // Some enumerants have operands of their own.
  constexpr int most_operands = 4;
  for (int more = 0; more <= most_operands; ++more, operands.push_back(id)) {
    Words words = before;
    const Words last = instruction(op, operands);
    words.insert(words.end(), last.begin(), last.end());
    const std::vector<std::string> text = disassembled(words);
    if (text.size() > position) return text[position];
  }
  return fmt::format("{}", number);
}

}  // namespace

std::string instruction_name(spv::Op op, std::span<const std::uint32_t> words) {
  const std::vector<std::string> text = disassembled(instruction(op, {words.begin(), words.end()}));
  return text.empty() ? fmt::format("SPIR-V opcode {}", static_cast<std::uint32_t>(op)) : text[0];
}

std::string folded_operation_name(std::span<const std::uint32_t> words) {
  const std::vector<std::string> text = disassembled(words);
  return text.size() > 2 ? text[2] : "an operation unknown";
}

std::string capability_name(std::uint32_t capability) { return word(spv::OpCapability, {capability}, 1, capability); }

std::string execution_model_name(std::uint32_t model) {
  const std::uint32_t empty_name = 0;
  return word(spv::OpEntryPoint, {model, id, empty_name}, 1, model);
}

std::string execution_mode_name(std::uint32_t mode) { return word(spv::OpExecutionMode, {id, mode}, 2, mode); }

std::string storage_class_name(std::uint32_t storage) {
  return word(spv::OpTypePointer, {id, storage, other_id}, 1, storage);
}

std::string decoration_name(std::uint32_t decoration) { return word(spv::OpDecorate, {id, decoration}, 2, decoration); }

std::string built_in_name(std::uint32_t built_in) {
  return word(spv::OpDecorate, {id, spv::DecorationBuiltIn, built_in}, 3, built_in);
}

std::string dimension_name(std::uint32_t dimension) {
  return word(spv::OpTypeImage, {id, other_id, dimension, 0, 0, 0, 2, spv::ImageFormatUnknown}, 2, dimension);
}

std::string image_format_name(std::uint32_t format) {
  return word(spv::OpTypeImage, {id, other_id, spv::Dim2D, 0, 0, 0, 2, format}, 7, format);
}

std::string extended_instruction_name(std::uint32_t instruction_number) {
  const Words set = instruction(spv::OpExtInstImport, {id, 0x4c534c47, 0x6474732e, 0x3035342e, 0});  // "GLSL.std.450"
  return word(spv::OpExtInst, {other_id, 3, id, instruction_number}, 3, instruction_number, set);
}

}  // namespace tandem::rhi
