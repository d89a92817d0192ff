#include "rhi_cpu/translate/instructions/instruction.hpp"

#include <utility>

namespace tandem::cpu {
namespace {

/// How many words at the beginning are the result and its type.
std::size_t result_words(spv::Op op) {
  bool has_result = false;
  bool has_type = false;
  spv::HasResultAndType(op, &has_result, &has_type);
  return std::size_t{has_result} + std::size_t{has_type};
}

/// The operands [first, second) that are literals.
std::pair<std::size_t, std::size_t> literals(spv::Op op, std::size_t count) {
  switch (op) {
    case spv::OpCompositeExtract:
      return {1, count};
    case spv::OpCompositeInsert:
    case spv::OpVectorShuffle:
      return {2, count};
    case spv::OpExtInst:
      return {1, 2};
    case spv::OpImageSampleImplicitLod:
    case spv::OpImageSampleExplicitLod:
    case spv::OpImageSampleProjImplicitLod:
    case spv::OpImageSampleProjExplicitLod:
    case spv::OpImageFetch:
    case spv::OpImageRead:
      return {2, 3};
    case spv::OpImageSampleDrefImplicitLod:
    case spv::OpImageSampleDrefExplicitLod:
    case spv::OpImageSampleProjDrefImplicitLod:
    case spv::OpImageSampleProjDrefExplicitLod:
    case spv::OpImageGather:
    case spv::OpImageDrefGather:
    case spv::OpImageWrite:
      return {3, 4};
    default:
      return {count, count};
  }
}

}  // namespace

Instruction::Instruction(spv::Op op, std::span<const std::uint32_t> words)
    : op_(op), words_(words), operands_(words.subspan(result_words(op))) {}

std::vector<std::uint32_t> Instruction::ids() const {
  const auto [first, second] = literals(op_, operands_.size());
  std::vector<std::uint32_t> result(words_.begin(),
                                    words_.begin() + static_cast<std::ptrdiff_t>(words_.size() - operands_.size()));
  for (std::size_t i = 0; i < operands_.size(); ++i)
    if (i < first || i >= second) result.push_back(operands_[i]);
  return result;
}

}  // namespace tandem::cpu
