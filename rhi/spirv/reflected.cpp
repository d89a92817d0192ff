#include "rhi/spirv/reflected.hpp"

#include <unordered_set>

#include "rhi/spirv/words.hpp"

namespace tandem::rhi {
namespace {

/// Positions of the operands of an instruction that may be pointers as values: first, step, end.
struct Operands {
  std::size_t first = 0;
  std::size_t step = 1;
  std::size_t end = 0;
};

Operands pointer_values(spv::Op op, std::size_t length) {
  switch (op) {
    case spv::OpPhi:
      return {.first = 3, .step = 2, .end = length};
    case spv::OpReturnValue:
      return {.first = 1, .end = 2};
    case spv::OpStore:
      return {.first = 2, .end = 3};
    case spv::OpPtrEqual:
    case spv::OpPtrNotEqual:
    case spv::OpPtrDiff:
      return {.first = 3, .end = 5};
    default:
      return {};
  }
}

}  // namespace

std::vector<std::uint32_t> without_composite_nulls(std::span<const std::uint32_t> spirv) {
  std::vector<std::uint32_t> result(spirv.begin(), spirv.end());
  std::unordered_set<std::uint32_t> composites;
  for_each_instruction(std::span(result), [&](std::span<std::uint32_t> i) {
    const spv::Op op = operation_of(i);
    if (op == spv::OpTypeArray || op == spv::OpTypeStruct) composites.insert(i[1]);
    if (op == spv::OpConstantNull && composites.contains(i[1])) i[0] = 3u << 16 | spv::OpUndef;
  });
  return result;
}

std::vector<std::uint32_t> variables_used_as_values(std::span<const std::uint32_t> spirv) {
  std::unordered_set<std::uint32_t> variables, used;
  for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    const spv::Op op = operation_of(i);
    if (op == spv::OpVariable && i[3] != spv::StorageClassFunction) variables.insert(i[2]);
    const Operands operands = pointer_values(op, i.size());
    for (std::size_t k = operands.first; k < operands.end; k += operands.step)
      if (variables.contains(i[k])) used.insert(i[k]);
  });
  return {used.begin(), used.end()};
}

}  // namespace tandem::rhi
