#include "rhi_cpu/translate/instructions/instruction.hpp"

namespace tandem::cpu {
namespace {

/// How many words at the beginning are the result and its type.
std::size_t result_words(spv::Op op) {
  bool has_result = false;
  bool has_type = false;
  spv::HasResultAndType(op, &has_result, &has_type);
  return std::size_t{has_result} + std::size_t{has_type};
}

}  // namespace

Instruction::Instruction(spv::Op op, std::span<const std::uint32_t> words)
    : op_(op), words_(words), operands_(words.subspan(result_words(op))) {}

}  // namespace tandem::cpu
