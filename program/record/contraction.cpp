#include "program/record/contraction.hpp"

#include <algorithm>
#include <unordered_set>

#include "program/record/components.hpp"
#include "program/record/globals.hpp"

namespace tandem::program {
namespace {

bool is_arithmetic(spv::Op op) {
  return (op >= spv::OpFNegate && op <= spv::OpDot && op != spv::OpIAdd && op != spv::OpISub && op != spv::OpIMul) ||
         op == spv::OpExtInst;
}

bool computes_floats(const Module& module, const Instruction& instruction) {
  if (!is_arithmetic(instruction.op)) return false;
  const auto components = components_of(module, instruction.type);
  return components && std::ranges::any_of(*components, [](const Component& component) {
           return component.kind == ComponentKind::floating;
         });
}

}  // namespace

bool may_be_contracted(const Module& module, const Instruction& instruction) {
  return computes_floats(module, instruction) &&
         std::ranges::none_of(module.instructions, [&](const Instruction& each) {
           return each.op == spv::OpDecorate && each.words[1] == instruction.result &&
                  each.words[2] == spv::DecorationNoContraction;
         });
}

std::vector<std::uint32_t> without_contraction(const Module& module) {
  std::vector<std::uint32_t> spirv(module.header.begin(), module.header.end());
  const auto append = [&](const std::vector<std::uint32_t>& words) {
    spirv.insert(spirv.end(), words.begin(), words.end());
  };
  std::unordered_set<std::uint32_t> decorated;
  for (std::size_t i = 0; i < module.first_global; ++i) {
    const std::vector<std::uint32_t>& words = module.instructions[i].words;
    append(words);
    if (module.instructions[i].op == spv::OpDecorate && words[2] == spv::DecorationNoContraction)
      decorated.insert(words[1]);
  }
  for (std::size_t i = module.first_function; i < module.instructions.size(); ++i) {
    const Instruction& instruction = module.instructions[i];
    if (computes_floats(module, instruction) && !decorated.contains(instruction.result))
      append(encode(spv::OpDecorate, {instruction.result, spv::DecorationNoContraction}));
  }
  for (std::size_t i = module.first_global; i < module.instructions.size(); ++i) append(module.instructions[i].words);
  return spirv;
}

}  // namespace tandem::program
