// Which values of a module the wide form must keep per lane.

#include <algorithm>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRBlock;
using spirv_cross::SPIRConstant;
using spirv_cross::SPIRFunction;
using spirv_cross::SPIRType;
using spirv_cross::SPIRVariable;

namespace {

std::size_t at(int block) { return static_cast<std::size_t>(block); }

bool is_atomic(spv::Op op) {
  return (op >= spv::OpAtomicLoad && op <= spv::OpAtomicXor) || op == spv::OpAtomicFAddEXT ||
         op == spv::OpAtomicFMinEXT || op == spv::OpAtomicFMaxEXT;
}

/// Built-ins with one value for a workgroup, and so for a subgroup.
bool is_common(std::uint32_t built_in) {
  return built_in == spv::BuiltInNumWorkgroups || built_in == spv::BuiltInWorkgroupId ||
         built_in == spv::BuiltInWorkgroupSize || built_in == spv::BuiltInSubgroupSize ||
         built_in == spv::BuiltInNumSubgroups || built_in == spv::BuiltInSubgroupId;
}

}  // namespace

std::vector<std::uint32_t> Printer::successors_of(std::uint32_t block_id) const {
  const SPIRBlock& block = get<SPIRBlock>(block_id);
  std::vector<std::uint32_t> found;
  const auto add = [&](std::uint32_t next) {
    if (next != 0 && std::find(found.begin(), found.end(), next) == found.end()) found.push_back(next);
  };
  switch (block.terminator) {
    case SPIRBlock::Direct:
      add(block.next_block);
      break;
    case SPIRBlock::Select:
      if (const auto* condition = maybe_get<SPIRConstant>(block.condition)) {
        add(condition->scalar() != 0 ? block.true_block : block.false_block);
      } else {
        add(block.true_block);
        add(block.false_block);
      }
      break;
    case SPIRBlock::MultiSelect:
      for (const auto& each : get_case_list(block)) add(each.block);
      add(block.default_block);
      break;
    case SPIRBlock::Return:
    case SPIRBlock::Unreachable:
      break;
    default:
      fail("the end of a block in the wide form");
  }
  return found;
}

WideFunction& Printer::wide_function(std::uint32_t function_id) {
  if (const auto known = wide_functions_.find(function_id); known != wide_functions_.end()) return known->second;
  WideFunction& function = wide_functions_[function_id];
  function.block_ids = {get<SPIRFunction>(function_id).entry_block};
  function.numbers[function.block_ids[0]] = 0;
  const auto number = [&](std::uint32_t id) {
    const auto [place, is_new] = function.numbers.try_emplace(id, static_cast<int>(function.block_ids.size()));
    if (is_new) function.block_ids.push_back(id);
    return place->second;
  };
  for (std::size_t i = 0; i < function.block_ids.size(); ++i) {
    const SPIRBlock& block = get<SPIRBlock>(function.block_ids[i]);
    FlowGraph::Block flow;
    for (const std::uint32_t next : successors_of(function.block_ids[i])) flow.successors.push_back(number(next));
    // SPIRV-Cross keeps them in different places.
    if (block.merge == SPIRBlock::MergeSelection && block.next_block != 0u) flow.merge = number(block.next_block);
    if (block.merge == SPIRBlock::MergeLoop) {
      flow.merge = number(block.merge_block);
      flow.continue_target = number(block.continue_block);
    }
    function.graph.blocks.push_back(std::move(flow));
  }
  function.flow = analyze(function.graph);
  const std::size_t count = function.block_ids.size();
  function.is_divergent.assign(count, 0);
  function.joins_differ.assign(count, 0);
  function.branch_varies.assign(count, 0);
  return function;
}

std::uint32_t Printer::root_variable(std::uint32_t pointer_id) const {
  const auto known = roots_.find(pointer_id);
  return known != roots_.end() ? known->second : pointer_id;
}

void Printer::find_definitions(std::uint32_t function_id) {
  const WideFunction& function = wide_function(function_id);
  for (const int number : function.flow.order) {
    const SPIRBlock& block = get<SPIRBlock>(function.block_ids[at(number)]);
    for (const auto& phi : block.phi_variables) definitions_[phi.function_variable] = {function_id, number};
    for (const auto& each : block.ops) {
      const Instruction i = view(each);
      if (i.has_result()) definitions_[i.result()] = {function_id, number};
      const bool follows = i.op() == spv::OpAccessChain || i.op() == spv::OpInBoundsAccessChain ||
                           i.op() == spv::OpPtrAccessChain || i.op() == spv::OpCopyObject ||
                           i.op() == spv::OpImageTexelPointer;
      if (follows) roots_[i.result()] = root_variable(i.operand(0));
    }
  }
  // A use outside of the loop sees what each lane had when it left the loop. A pointer is only the text of its
  // operands.
  const auto use = [&](const auto& self, std::uint32_t id, int in_block) -> void {
    const auto definition = definitions_.find(id);
    if (definition == definitions_.end() || definition->second.function != function_id) return;
    if (function.flow.is_in_loop(in_block, function.flow.loop[at(definition->second.block)])) return;
    if (!escapes_.insert(id).second) return;
    const SPIRBlock& block = get<SPIRBlock>(function.block_ids[at(definition->second.block)]);
    for (const auto& each : block.ops) {
      const Instruction i = view(each);
      if (!i.has_result() || i.result() != id || !is_pointer(get<SPIRType>(i.result_type()))) continue;
      for (std::size_t k = 0; k < i.operand_count(); ++k) self(self, i.operand(k), in_block);
    }
  };
  for (const int number : function.flow.order) {
    const SPIRBlock& block = get<SPIRBlock>(function.block_ids[at(number)]);
    for (const auto& phi : block.phi_variables) use(use, phi.local_variable, number);
    for (const auto& each : block.ops) {
      const Instruction i = view(each);
      for (const std::uint32_t word : i.ids()) use(use, word, number);
    }
    if (block.terminator == SPIRBlock::Select || block.terminator == SPIRBlock::MultiSelect)
      use(use, block.condition, number);
    if (block.return_value != 0) use(use, block.return_value, number);
  }
}

void Printer::analyze_uniformity() {
  std::vector<std::uint32_t> functions;
  const auto visit = [&](const auto& self, std::uint32_t id) -> void {
    if (std::find(functions.begin(), functions.end(), id) != functions.end()) return;
    const WideFunction& function = wide_function(id);
    for (const int number : function.flow.order)
      for (const auto& each : get<SPIRBlock>(function.block_ids[at(number)]).ops)
        if (each.op == spv::OpFunctionCall) self(self, view(each).operand(0));
    functions.push_back(id);
  };
  visit(visit, ir.default_entry_point);
  for (const std::uint32_t id : functions) find_definitions(id);

  ir.for_each_typed_id<SPIRVariable>([&](std::uint32_t id, SPIRVariable& variable) {
    // Parameters that are values are variables of SPIRV-Cross too.
    if (variable.phi_variable || !is_pointer(get<Type>(variable.basetype))) return;
    if (variable.storage == spv::StorageClassPrivate) uniformity_.varying_contents.insert(id);
    if (variable.storage == spv::StorageClassInput && has_decoration(id, spv::DecorationBuiltIn) &&
        !is_common(get_decoration(id, spv::DecorationBuiltIn)))
      uniformity_.varying_contents.insert(id);
    if (variable.storage == spv::StorageClassFunction &&
        get<Type>(pointee(variable.basetype)).basetype == SPIRType::RayQuery)
      uniformity_.varying_contents.insert(id);
  });
  // A pointer parameter to a Function variable: what the callee does to it is not followed.
  for (const std::uint32_t id : functions)
    for (const auto& parameter : get<SPIRFunction>(id).arguments)
      if (const Type& type = get<Type>(parameter.type);
          is_pointer(type) && (type.storage == spv::StorageClassFunction || type.storage == spv::StorageClassPrivate))
        uniformity_.varying_contents.insert(parameter.id);

  for (bool changed = true; changed;) {
    changed = false;
    for (const std::uint32_t id : functions) changed |= update_uniformity(id);
  }
}

bool Printer::update_uniformity(std::uint32_t function_id) {
  WideFunction& function = wide_function(function_id);
  bool changed = false;
  const auto is_varying = [&](std::uint32_t id) { return uniformity_.varying.contains(id); };
  const auto mark = [&](std::unordered_set<std::uint32_t>& set, std::uint32_t id) { changed |= set.insert(id).second; };

  for (const int number : function.flow.order) {
    const SPIRBlock& block = get<SPIRBlock>(function.block_ids[at(number)]);
    const int loop = function.flow.loop[at(number)];
    const bool leaves_in_rounds = loop != no_block && function.is_divergent[at(loop)];
    for (const auto& phi : block.phi_variables)
      if (is_varying(phi.local_variable) || function.joins_differ[at(number)] ||
          (leaves_in_rounds && escapes_.contains(phi.function_variable)))
        mark(uniformity_.varying, phi.function_variable);
    for (const auto& each : block.ops) {
      const Instruction i = view(each);
      bool varies = false;
      for (const std::uint32_t word : i.ids()) varies |= is_varying(word);
      switch (i.op()) {
        case spv::OpLoad: {
          const std::uint32_t root = root_variable(i.operand(0));
          varies |= uniformity_.varying_contents.contains(root);
          break;
        }
        case spv::OpStore: {
          const std::uint32_t root = root_variable(i.operand(0));
          const auto* variable = maybe_get<SPIRVariable>(root);
          if (variable != nullptr && variable->storage == spv::StorageClassFunction && !variable->phi_variable &&
              (varies || function.is_divergent[at(number)]))
            mark(uniformity_.varying_contents, root);
          continue;
        }
        case spv::OpFunctionCall: {
          const SPIRFunction& callee = get<SPIRFunction>(i.operand(0));
          for (std::size_t k = 1; k < i.operand_count(); ++k) {
            const std::uint32_t argument = i.operand(k), parameter = callee.arguments[k - 1].id;
            const Type& type = get<Type>(callee.arguments[k - 1].type);
            if (is_pointer(type) &&
                (type.storage == spv::StorageClassFunction || type.storage == spv::StorageClassPrivate))
              mark(uniformity_.varying_contents, root_variable(argument));
            else if (is_varying(argument))
              mark(uniformity_.varying, parameter);
          }
          varies = uniformity_.varying_functions.contains(i.operand(0));
          break;
        }
        case spv::OpReadClockKHR:
          varies = true;
          break;
        case spv::OpExtInst:
          // Those that write through a pointer.
          for (const std::uint32_t word : i.ids())
            if (const auto* variable = maybe_get<SPIRVariable>(root_variable(word));
                variable != nullptr && !variable->phi_variable && is_pointer(get<Type>(variable->basetype)) &&
                (variable->storage == spv::StorageClassFunction || variable->storage == spv::StorageClassPrivate)) {
              mark(uniformity_.varying_contents, root_variable(word));
              varies = true;
            }
          break;
        default:
          varies |= is_atomic(i.op()) || (is_subgroup_operation(i.op()) && !is_ballot_query(i.op()));
          for (const std::uint32_t word : i.ids())
            if (const auto* variable = maybe_get<SPIRVariable>(root_variable(word));
                variable != nullptr && get<Type>(variable->basetype).basetype == SPIRType::RayQuery)
              varies = true;
          break;
      }
      if (!i.has_result()) continue;
      if (varies || (leaves_in_rounds && escapes_.contains(i.result()))) mark(uniformity_.varying, i.result());
    }
    const bool chooses = block.terminator == SPIRBlock::Select || block.terminator == SPIRBlock::MultiSelect;
    if (chooses && function.graph.blocks[at(number)].successors.size() > 1 && is_varying(block.condition))
      changed |= mark_divergence(function, number);
    if (block.terminator == SPIRBlock::Return && block.return_value != 0 &&
        (is_varying(block.return_value) || function.is_divergent[at(number)]))
      mark(uniformity_.varying_functions, function_id);
  }
  return changed;
}

}  // namespace tandem::cpu
