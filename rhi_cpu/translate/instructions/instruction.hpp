#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <spirv_cross/spirv.hpp>

namespace tandem::cpu {

/// A view of one instruction. In the binary, an instruction with a result begins with the id of the result's type and
/// the id of the result; operands are counted from the first word behind those.
class Instruction {
 public:
  /// @param words that follow the opcode, of a valid instruction; they must outlive the view
  Instruction(spv::Op op, std::span<const std::uint32_t> words);

  spv::Op op() const { return op_; }
  /// Whether it has a result with a type.
  bool has_result() const { return words_.size() - operands_.size() == 2; }
  /// Ids, of an instruction that has a result.
  std::uint32_t result_type() const { return words_[0]; }
  std::uint32_t result() const { return words_[1]; }
  /// An id or a literal.
  std::uint32_t operand(std::size_t i) const { return operands_[i]; }
  std::size_t operand_count() const { return operands_.size(); }
  /// All that follow the opcode.
  std::span<const std::uint32_t> words() const { return words_; }
  /// Those of `words` that are ids, and literals that no id of a value can be taken for: the indices of composites, the
  /// numbers of extended instructions and the masks of image operands are left out.
  std::vector<std::uint32_t> ids() const;

 private:
  spv::Op op_;
  std::span<const std::uint32_t> words_;
  std::span<const std::uint32_t> operands_;
};

}  // namespace tandem::cpu
