#include "program/explain/source.hpp"

#include <fmt/format.h>

#include <bit>
#include <string_view>

#include "rhi/spirv/names.hpp"

namespace tandem::program {
namespace {

std::string text_of(const Instruction& instruction, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < instruction.words.size(); ++i)
    for (unsigned shift = 0; shift < 32; shift += 8) {
      const char c = static_cast<char>(instruction.words[i] >> shift);
      if (c == '\0') return text;
      text.push_back(c);
    }
  return text;
}

/// The whole source of a file, as OpSource and OpSourceContinued have it.
std::string source_text(const Module& module, std::uint32_t file) {
  std::string text;
  bool follows = false;
  for (std::size_t i = 0; i < module.first_global; ++i) {
    const Instruction& instruction = module.instructions[i];
    if (instruction.op == spv::OpSource) {
      follows = instruction.words.size() > 4 && instruction.words[3] == file;
      if (follows) text += text_of(instruction, 4);
    } else if (instruction.op == spv::OpSourceContinued) {
      if (follows) text += text_of(instruction, 1);
    }
  }
  return text;
}

std::string line_of(std::string_view text, std::uint32_t line) {
  for (std::uint32_t i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return "";
    text.remove_prefix(end + 1);
  }
  text = text.substr(0, text.find('\n'));
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") + 1 - first));
}

std::string scalar_constant(const Module& module, const Instruction& constant) {
  const Instruction& type = definition(module, constant.type);
  const std::uint32_t bits = constant.words[3];
  if (type.op == spv::OpTypeFloat && type.words[2] == 32) return fmt::format("{}", std::bit_cast<float>(bits));
  if (type.op == spv::OpTypeInt && type.words[2] == 32)
    return type.words[3] != 0 ? std::to_string(static_cast<std::int32_t>(bits)) : std::to_string(bits);
  return "";
}

}  // namespace

SourcePlace source_of(const Module& module, std::size_t instruction) {
  const SourceLine& line = module.instructions[instruction].line;
  if (line.line == 0) return {};
  return {string_of(module, line.file), line.line, line_of(source_text(module, line.file), line.line)};
}

std::string name_of(const Module& module, std::uint32_t id) {
  if (const auto found = module.names.find(id); found != module.names.end() && !found->second.empty())
    return found->second;
  const auto found = module.definitions.find(id);
  if (found != module.definitions.end()) {
    const Instruction& definition = module.instructions[found->second];
    if (definition.op == spv::OpLoad) return name_of(module, definition.words[3]);
    if (definition.op == spv::OpConstant)
      if (std::string text = scalar_constant(module, definition); !text.empty()) return text;
    if (definition.op == spv::OpAccessChain || definition.op == spv::OpInBoundsAccessChain) {
      std::string text = name_of(module, definition.words[3]);
      if (text.starts_with('%')) text = "";  // a block without a name
      for (std::size_t i = 4; i < definition.words.size(); ++i)
        text += fmt::format("[{}]", name_of(module, definition.words[i]));
      return text;
    }
  }
  return fmt::format("%{}", id);
}

std::string describe_instruction(const Module& module, std::size_t instruction) {
  const Instruction& described = module.instructions[instruction];
  std::span<const std::uint32_t> operands(described.words);
  std::string text = rhi::instruction_name(described.op, operands.subspan(1));
  std::size_t first = 0;
  if (described.op == spv::OpExtInst) {
    text = rhi::extended_instruction_name(described.words[4]);
    first = 1;  // the set
  }
  std::string separator = " ";
  for (std::size_t i = first; i < described.used_ids.size(); ++i) {
    text += separator + name_of(module, described.words[described.used_ids[i]]);
    separator = ", ";
  }
  return text;
}

}  // namespace tandem::program
