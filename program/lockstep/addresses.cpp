#include "program/lockstep/addresses.hpp"

namespace tandem::program {
namespace {

/// The literal of a decoration of an id, or of a member of a type.
std::optional<std::uint32_t> decoration_of(const Module& module, std::uint32_t id, spv::Decoration decoration) {
  for (std::size_t i = 0; i < module.first_global; ++i) {
    const Instruction& instruction = module.instructions[i];
    if (instruction.op == spv::OpDecorate && instruction.words[1] == id &&
        instruction.words[2] == static_cast<std::uint32_t>(decoration) && instruction.words.size() > 3)
      return instruction.words[3];
  }
  return std::nullopt;
}

std::optional<std::uint32_t> member_decoration_of(const Module& module, std::uint32_t type, std::uint32_t member,
                                                  spv::Decoration decoration) {
  for (std::size_t i = 0; i < module.first_global; ++i) {
    const Instruction& instruction = module.instructions[i];
    if (instruction.op == spv::OpMemberDecorate && instruction.words[1] == type && instruction.words[2] == member &&
        instruction.words[3] == static_cast<std::uint32_t>(decoration))
      return instruction.words.size() > 4 ? instruction.words[4] : 1;
  }
  return std::nullopt;
}

/// A type on the way to a value, with the layout that the structure around it gives to a matrix.
struct Layout {
  std::uint32_t type = 0;
  std::uint32_t matrix_stride = 0;
  bool row_major = false;
  std::uint32_t component_stride = 0;  ///< of a column of a row-major matrix; 0: tightly packed
};

std::uint64_t size_of(const Module& module, const Layout& layout) {
  const std::vector<std::uint32_t>& words = definition(module, layout.type).words;
  switch (definition(module, layout.type).op) {
    case spv::OpTypeInt:
    case spv::OpTypeFloat:
      return words[2] / 8;
    case spv::OpTypeVector: {
      const std::uint64_t component = size_of(module, {.type = words[2]});
      return layout.component_stride != 0 ? std::uint64_t{layout.component_stride} * (words[3] - 1) + component
                                          : component * words[3];
    }
    case spv::OpTypeMatrix:
      return std::uint64_t{layout.matrix_stride} *
             (layout.row_major ? definition(module, words[2]).words[3] : words[3]);
    case spv::OpTypeArray:
      return std::uint64_t{decoration_of(module, layout.type, spv::DecorationArrayStride).value_or(0)} *
             definition(module, words[3]).words[3];
    case spv::OpTypeStruct: {
      if (words.size() == 2) return 0;
      const auto last = static_cast<std::uint32_t>(words.size() - 3);
      return member_decoration_of(module, layout.type, last, spv::DecorationOffset).value_or(0) +
             size_of(module,
                     {.type = words.back(),
                      .matrix_stride =
                          member_decoration_of(module, layout.type, last, spv::DecorationMatrixStride).value_or(0)});
    }
    default:
      return 0;
  }
}

/// Steps into an element, a member, a column or a component; false where the layout is not declared.
bool step(const Module& module, std::uint32_t index, Layout& layout, std::uint64_t& offset) {
  const Instruction& type = definition(module, layout.type);
  switch (type.op) {
    case spv::OpTypeStruct: {
      if (index + 2 >= type.words.size()) return false;
      const auto member = [&](spv::Decoration decoration) {
        return member_decoration_of(module, layout.type, index, decoration);
      };
      const std::optional<std::uint32_t> begin = member(spv::DecorationOffset);
      if (!begin) return false;
      offset += *begin;
      layout = {.type = type.words[index + 2],
                .matrix_stride = member(spv::DecorationMatrixStride).value_or(0),
                .row_major = member(spv::DecorationRowMajor).has_value()};
      return true;
    }
    case spv::OpTypeArray:
    case spv::OpTypeRuntimeArray: {
      const std::optional<std::uint32_t> stride = decoration_of(module, layout.type, spv::DecorationArrayStride);
      if (!stride) return false;
      offset += std::uint64_t{*stride} * index;
      layout.type = type.words[2];
      return true;
    }
    case spv::OpTypeMatrix: {
      const std::uint64_t component = size_of(module, {.type = definition(module, type.words[2]).words[2]});
      offset += index * (layout.row_major ? component : layout.matrix_stride);
      layout = {.type = type.words[2], .component_stride = layout.row_major ? layout.matrix_stride : 0};
      return true;
    }
    case spv::OpTypeVector: {
      const std::uint64_t component = size_of(module, {.type = type.words[2]});
      offset += index * (layout.component_stride != 0 ? layout.component_stride : component);
      layout = {.type = type.words[2]};
      return true;
    }
    default:
      return false;
  }
}

}  // namespace

std::optional<BlockRange> block_range(const Walk& walk, std::uint32_t pointer) {
  const Module& module = walk.shader().module;
  std::vector<std::uint32_t> indices;  // from the innermost on
  for (;;) {
    const auto found = module.definitions.find(pointer);
    if (found == module.definitions.end()) return std::nullopt;
    const Instruction& instruction = module.instructions[found->second];
    if (instruction.op == spv::OpVariable) break;
    if (instruction.op != spv::OpAccessChain && instruction.op != spv::OpInBoundsAccessChain) return std::nullopt;
    for (std::size_t i = instruction.words.size(); i-- > 4;) {
      const std::optional<RecordedWords> index = walk.value_of(instruction.words[i]);
      if (!index) return std::nullopt;
      indices.push_back(index->words[0]);
    }
    pointer = instruction.words[3];
  }
  const Instruction& variable = definition(module, pointer);
  const auto storage = static_cast<spv::StorageClass>(variable.words[3]);
  if (storage != spv::StorageClassStorageBuffer && storage != spv::StorageClassUniform) return std::nullopt;
  Layout layout{.type = definition(module, variable.type).words[3]};
  if (definition(module, layout.type).op != spv::OpTypeStruct) return std::nullopt;
  BlockRange range{.variable = pointer};
  for (std::size_t i = indices.size(); i-- > 0;)
    if (!step(module, indices[i], layout, range.offset)) return std::nullopt;
  range.size = size_of(module, layout);
  return range;
}

std::optional<DescriptorPlace> descriptor_of(const Module& module, std::uint32_t variable) {
  const std::optional<std::uint32_t> set = decoration_of(module, variable, spv::DecorationDescriptorSet);
  const std::optional<std::uint32_t> binding = decoration_of(module, variable, spv::DecorationBinding);
  if (!set || !binding) return std::nullopt;
  return DescriptorPlace{*set, *binding};
}

}  // namespace tandem::program
