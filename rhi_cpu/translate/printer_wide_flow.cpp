// Control flow in the wide form. Every block has a mask of the lanes that execute it. A block runs after all blocks
// that lead to it, and each of these adds lanes to its mask, so lanes come together where their ways meet; a loop goes
// on until no lane goes around again.

#include <algorithm>

#include <fmt/format.h>

#include "rhi_cpu/translate/prepare.hpp"
#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRBlock;
using spirv_cross::SPIRFunction;
using spirv_cross::SPIRType;
using spirv_cross::SPIRVariable;

namespace {

std::size_t at(int block) { return static_cast<std::size_t>(block); }

}  // namespace

/// A function while it is printed.
struct Printer::WidePrinting {
  std::uint32_t function_id;
  const WideFunction& function;
  const ControlFlow& flow;
  std::vector<std::string> masks = {};   ///< by block, while it runs
  std::vector<std::string> guards = {};  ///< by block: the condition it is run under, "" where its dominator's suffices
  std::vector<char> has_mask = {};       ///< by block: its mask is a variable that edges add to
  std::vector<std::vector<int>> children = {};         ///< of a block in the dominator tree, in order
  std::vector<std::vector<int>> declared = {};         ///< blocks whose mask and phis are declared when a block begins
  std::vector<std::vector<int>> declared_before = {};  ///< the same, in front of a header's loop
  std::vector<char> is_phi_set = {};                   ///< by block: an edge has set its phis already
  std::vector<std::vector<int>> after_loop = {};       ///< by header: blocks that wait for the end of its loop
  std::vector<std::string> entered = {};               ///< by header: the mask of the lanes that begin its loop
  bool has_one_return = false;
};

void Printer::print_wide_functions(std::uint32_t function_id) {
  if (!printed_functions_.insert(function_id).second) return;
  const WideFunction& function = wide_function(function_id);
  for (const int number : function.flow.order)
    for (const auto& each : get<SPIRBlock>(function.block_ids[at(number)]).ops)
      if (each.op == spv::OpFunctionCall) print_wide_functions(view(each).operand(0));
  print_wide_function(function_id);
}

void Printer::print_wide_prototype(std::uint32_t function_id) {
  SPIRFunction& function = get<SPIRFunction>(function_id);
  const bool is_entry = function_id == std::uint32_t(ir.default_entry_point);
  processing_entry_point = is_entry;
  local_variable_names = resource_names;
  std::string parameters = "const k::Mask entered";
  for (auto& parameter : function.arguments) {
    add_local_variable_name(parameter.id);
    if (auto* variable = maybe_get<SPIRVariable>(parameter.id)) variable->parameter = &parameter;
    const Type& type = get<Type>(parameter.type);
    const std::string name = to_name(parameter.id);
    parameters += ", ";
    mode_ = varies(parameter.id) ? Mode::wide : Mode::common;
    if (!is_pointer(type) || is_buffer(type.storage)) {
      if (is_pointer(type) && get<Type>(pointee(parameter.type)).columns > 1)
        fail("a pointer to a matrix in a buffer as parameter");
      const bool is_constant = is_pointer(type) && type.storage == spv::StorageClassPushConstant;
      parameters += (is_constant ? "const std::byte*" : type_name(type)) + " " + name;
      if (is_pointer(type)) addresses_[parameter.id] = {.bytes = name, .resource = "", .varies = varies(parameter.id)};
    } else if (is_shared_pointer(type)) {
      if (varies(parameter.id)) fail("a pointer into shared memory that differs between invocations, in the wide form");
      parameters += type_name(type) + " " + name;
    } else if (type.storage == spv::StorageClassUniformConstant) {
      mode_ = Mode::common;
      parameters += descriptor_parameter(get<Type>(pointee(parameter.type))) + " " + name;
    } else {
      mode_ = Mode::wide;
      parameters += type_name(pointee(parameter.type)) + "& " + name;
    }
  }
  mode_ = uniformity_.varying_functions.contains(function_id) ? Mode::wide : Mode::common;
  const std::string result =
      get<Type>(function.return_type).basetype == SPIRType::Void ? "void" : type_name(function.return_type);
  mode_ = Mode::common;
  statement(is_entry ? "[[gnu::always_inline]] " : "", "inline ", result, " ", to_name(function.self), "(", parameters,
            ")");
}

void Printer::print_wide_function(std::uint32_t function_id) {
  SPIRFunction& spirv = get<SPIRFunction>(function_id);
  const WideFunction& function = wide_function(function_id);
  WidePrinting printing{.function_id = function_id, .function = function, .flow = function.flow};
  place_blocks(printing);

  print_wide_prototype(function_id);
  begin_scope();
  for (const std::uint32_t id : spirv.local_variables) {
    if (get<SPIRVariable>(id).phi_variable) continue;
    add_local_variable_name(id);
    const Type& type = get<Type>(pointee(get<SPIRVariable>(id).basetype));
    mode_ = uniformity_.varying_contents.contains(id) ? Mode::wide : Mode::common;
    std::string initial = is_opaque(type) ? "" : "{}";
    if (const auto initializer = initializers_.find(id); initializer != initializers_.end())
      initial = " = " + value(initializer->second);
    statement(type_name(type), " ", to_name(id), initial, ";");
  }
  for (const auto& [id, definition] : definitions_) {
    if (definition.function != function_id || !escapes_.contains(id)) continue;
    print_escaping(id, definition.block);
  }
  mode_ = uniformity_.varying_functions.contains(function_id) ? Mode::wide : Mode::common;
  const bool returns = get<Type>(spirv.return_type).basetype != SPIRType::Void;
  if (returns) statement(type_name(spirv.return_type), " result;");
  mode_ = Mode::common;
  print_node(printing, 0);
  if (returns) statement("return result;");
  end_scope();
  statement("");
}

void Printer::print_escaping(std::uint32_t id, int block_number) {
  mode_ = varies(id) ? Mode::wide : Mode::common;
  const WideFunction& function = wide_function(definitions_.at(id).function);
  const SPIRBlock& block = get<SPIRBlock>(function.block_ids[at(block_number)]);
  for (const auto& phi : block.phi_variables)
    if (std::uint32_t(phi.function_variable) == id) {
      statement(type_name(get<SPIRVariable>(id).basetype), " v_", id, ";");
      mode_ = Mode::common;
      return;
    }
  for (const auto& each : block.ops) {
    const Instruction i = view(each);
    if (!i.has_result() || i.result() != id) continue;
    const Type& type = get<Type>(i.result_type());
    if (type.basetype == SPIRType::Void) break;
    if (is_pointer(type) && is_buffer(type.storage) && varies(id))
      statement("k::Addresses a_", id, ";");
    else if ((!is_pointer(type) || (is_buffer(type.storage) && !roots_.contains(id))) && !is_descriptor(type) &&
             !type_is_opaque_value(type))
      statement(type_name(type), " v_", id, ";");
    break;
  }
  mode_ = Mode::common;
}

void Printer::place_blocks(WidePrinting& printing) {
  const ControlFlow& flow = printing.flow;
  const std::size_t count = printing.function.block_ids.size();
  printing.masks.resize(count);
  printing.guards.resize(count);
  printing.entered.resize(count);
  printing.has_mask.assign(count, 0);
  printing.children.resize(count);
  printing.declared.resize(count);
  printing.declared_before.resize(count);
  printing.is_phi_set.assign(count, 0);
  printing.after_loop.resize(count);
  printing.masks[0] = "entered";
  for (const int block : flow.order) {
    if (block == 0) continue;
    const int dominator = flow.dominator[at(block)];
    printing.children[at(dominator)].push_back(block);

    // Whose mask it has: that of the nearest dominator in the same loop, where all its lanes come here.
    int same = dominator;
    while (same != no_block && flow.loop[at(same)] != flow.loop_around(block)) same = flow.dominator[at(same)];
    std::string mask;
    if (same != no_block && flow.is_equivalent(same, block)) {
      mask = printing.masks[at(same)];
    } else {
      const auto& from = flow.predecessors[at(block)];
      const SPIRBlock& last = get<SPIRBlock>(printing.function.block_ids[at(from[0])]);
      const bool is_side = from.size() == 1 && last.terminator == SPIRBlock::Select &&
                           printing.function.graph.blocks[at(from[0])].successors.size() == 2 &&
                           !printing.function.branch_varies[at(from[0])] &&
                           flow.loop[at(from[0])] == flow.loop_around(block) && !varies(last.condition);
      if (is_side) {
        mask = printing.masks[at(from[0])];
        const bool on_true = printing.function.numbers.at(last.true_block) == block;
        printing.guards[at(block)] = (on_true ? "true" : "false");
      } else {
        printing.has_mask[at(block)] = 1;
        printing.guards[at(block)] = "any";
      }
    }
    // A loop's mask loses lanes from round to round.
    const bool has_own = flow.is_header(block) || printing.has_mask[at(block)];
    printing.masks[at(block)] = has_own ? fmt::format("m_{}", block) : mask;
    printing.entered[at(block)] = mask;

    // Where its mask and its phis are declared.
    const int around = flow.loop_around(block);
    if (flow.loop[at(dominator)] == around) {
      printing.declared[at(dominator)].push_back(block);
    } else {
      int loop = flow.loop[at(dominator)];
      while (flow.outer_loop[at(loop)] != around) loop = flow.outer_loop[at(loop)];
      printing.declared_before[at(loop)].push_back(block);
    }
  }
  int returns = 0;
  for (const int block : flow.order)
    returns += get<SPIRBlock>(printing.function.block_ids[at(block)]).terminator == SPIRBlock::Return;
  printing.has_one_return = returns == 1;
}

void Printer::print_declarations(const WidePrinting& printing, const std::vector<int>& blocks) {
  for (const int block : blocks) {
    if (printing.has_mask[at(block)]) statement("k::Mask m_", block, "(false);");
    for (const auto& phi : get<SPIRBlock>(printing.function.block_ids[at(block)]).phi_variables) {
      const std::uint32_t id = phi.function_variable;
      if (escapes_.contains(id) || !declared_phis_.insert(id).second) continue;
      mode_ = varies(id) ? Mode::wide : Mode::common;
      const Type& type = get<Type>(get<SPIRVariable>(id).basetype);
      if (varies(id) && is_shared_pointer(type))
        fail("a pointer into shared memory that differs between invocations, in the wide form");
      statement(type_name(type), " v_", id, ";");
      mode_ = Mode::common;
    }
  }
}

void Printer::print_node(WidePrinting& printing, int block) {
  const ControlFlow& flow = printing.flow;
  const bool is_header = flow.is_header(block);
  if (is_header) {
    print_declarations(printing, printing.declared_before[at(block)]);
    if (!printing.has_mask[at(block)]) statement("k::Mask m_", block, " = ", printing.entered[at(block)], ";");
    statement("for (;;) {");
    statement("k::Mask n_", block, "(false);");
  }
  print_declarations(printing, printing.declared[at(block)]);
  mask_ = printing.masks[at(block)];
  const SPIRBlock& spirv = get<SPIRBlock>(printing.function.block_ids[at(block)]);
  for (const auto& each : spirv.ops) {
    const Instruction i = view(each);
    if (i.op() == loop_mark)
      print_look();
    else
      print_wide_instruction(i);
  }
  print_terminator(printing, block);
  for (const int child : printing.children[at(block)])
    if (flow.is_in_loop(child, flow.loop[at(block)])) print_child(printing, child);
  if (!is_header) {
    for (const int child : printing.children[at(block)])
      if (const int loop = flow.loop[at(block)]; !flow.is_in_loop(child, loop))
        printing.after_loop[at(loop)].push_back(child);
    return;
  }
  for (const int child : printing.children[at(block)])
    if (!flow.is_in_loop(child, block)) printing.after_loop[at(block)].push_back(child);
  statement("m_", block, " = n_", block, ";");
  statement("if (!k::any_of(m_", block, ")) break;");
  statement("}");
  std::vector<int> waiting = std::move(printing.after_loop[at(block)]);
  std::sort(waiting.begin(), waiting.end(), [&](int a, int b) { return flow.position[at(a)] < flow.position[at(b)]; });
  for (const int each : waiting) {
    if (const int around = flow.outer_loop[at(block)]; !flow.is_in_loop(each, around))
      printing.after_loop[at(around)].push_back(each);
    else
      print_child(printing, each);
  }
}

void Printer::print_child(WidePrinting& printing, int block) {
  const std::string& guard = printing.guards[at(block)];
  if (guard.empty()) return print_node(printing, block);
  if (guard == "any") {
    statement("if (k::any_of(", printing.masks[at(block)], ")) {");
  } else {
    const int from = printing.flow.predecessors[at(block)][0];
    const std::string condition = value(get<SPIRBlock>(printing.function.block_ids[at(from)]).condition);
    statement("if (", guard == "true" ? "" : "!", "(", condition, ")) {");
  }
  print_node(printing, block);
  statement("}");
}

void Printer::print_edge(WidePrinting& printing, int from, int to, const std::string& mask,
                         const std::string& condition) {
  const ControlFlow& flow = printing.flow;
  const bool is_back = flow.position[at(to)] <= flow.position[at(from)];
  const std::uint32_t from_id = printing.function.block_ids[at(from)];
  const SPIRBlock& target = get<SPIRBlock>(printing.function.block_ids[at(to)]);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> phis;  // and their values
  for (const auto& phi : target.phi_variables)
    if (std::uint32_t(phi.parent) == from_id) phis.emplace_back(phi.function_variable, phi.local_variable);
  const bool overlaps = std::any_of(phis.begin(), phis.end(), [&](const auto& a) {
    return std::any_of(phis.begin(), phis.end(), [&](const auto& b) { return a.second == b.first && a != b; });
  });
  // Before another edge has set it, there is nothing in any lane to be kept.
  const bool keeps = is_back ? false : (printing.is_phi_set[at(to)] || flow.loop[at(from)] != flow.loop_around(to));
  std::vector<std::string> copies;
  if (overlaps) statement("{");
  for (const auto& [phi, source] : phis) {
    mode_ = varies(phi) ? Mode::wide : Mode::common;
    std::string text = value(source);
    if (overlaps) {
      statement("const auto c_", phi, " = ", text, ";");
      text = fmt::format("c_{}", phi);
    }
    copies.push_back(text);
  }
  for (std::size_t k = 0; k < phis.size(); ++k) {
    const std::uint32_t phi = phis[k].first;
    if (!varies(phi))
      statement(condition.empty() ? "" : "if (" + condition + ") ", "v_", phi, " = ", copies[k], ";");
    else if (keeps || escapes_.contains(phi))
      statement("k::assign(", mask, ", v_", phi, ", ", copies[k], ");");
    else
      statement("v_", phi, " = ", copies[k], ";");
  }
  if (overlaps) statement("}");
  mode_ = Mode::common;
  if (!is_back) printing.is_phi_set[at(to)] = 1;
  if (is_back)
    statement("n_", to, " = n_", to, " || ", mask, ";");
  else if (printing.has_mask[at(to)])
    statement("m_", to, " = m_", to, " || ", mask, ";");
}

void Printer::print_terminator(WidePrinting& printing, int block) {
  const SPIRBlock& spirv = get<SPIRBlock>(printing.function.block_ids[at(block)]);
  const auto& successors = printing.function.graph.blocks[at(block)].successors;
  const std::string mask = printing.masks[at(block)];
  mode_ = Mode::common;
  if (spirv.terminator == SPIRBlock::Return && spirv.return_value != 0) {
    mode_ = uniformity_.varying_functions.contains(printing.function_id) ? Mode::wide : Mode::common;
    if (mode_ == Mode::wide && !printing.has_one_return)
      statement("k::assign(", mask, ", result, ", value(spirv.return_value), ");");
    else
      statement("result = ", value(spirv.return_value), ";");
    mode_ = Mode::common;
    return;
  }
  if (successors.size() == 1) return print_edge(printing, block, successors[0], mask, "");
  if (successors.empty()) return;

  const bool differs = varies(spirv.condition);
  mode_ = differs ? Mode::wide : Mode::common;
  const std::string chosen = value(spirv.condition);
  const auto number = [&](std::uint32_t id) { return printing.function.numbers.at(id); };
  std::vector<std::pair<int, std::string>> ways;
  if (spirv.terminator == SPIRBlock::Select) {
    ways = {{number(spirv.true_block), chosen}, {number(spirv.false_block), fmt::format("!({})", chosen)}};
  } else {
    std::string others;
    for (const auto& each : get_case_list(spirv)) {
      if (each.block == spirv.default_block) continue;
      const std::string is_case = fmt::format("{} == {}", chosen, case_text(spirv, each.value));
      others += (others.empty() ? "" : " || ") + fmt::format("({})", is_case);
      const auto known =
          std::find_if(ways.begin(), ways.end(), [&](const auto& way) { return way.first == number(each.block); });
      if (known != ways.end())
        known->second += fmt::format(" || ({})", is_case);
      else
        ways.emplace_back(number(each.block), fmt::format("({})", is_case));
    }
    ways.emplace_back(number(spirv.default_block), others.empty() ? "true" : fmt::format("!({})", others));
  }
  mode_ = Mode::common;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const auto& [to, condition] = ways[k];
    const std::string name = fmt::format("w_{}_{}", block, k);
    if (differs) {
      statement("const k::Mask ", name, " = ", mask, " && (", condition, ");");
    } else {
      // What it is made of may be a phi that an edge sets.
      statement("const bool c_", name, " = ", condition, ";");
      statement("const k::Mask ", name, " = c_", name, " ? ", mask, " : k::Mask(false);");
    }
  }
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const std::string name = fmt::format("w_{}_{}", block, k);
    print_edge(printing, block, ways[k].first, name, differs ? "" : "c_" + name);
  }
}

std::string Printer::case_text(const SPIRBlock& block, std::uint64_t number) {
  const Type& type = type_of(block.condition);
  if (type.width == 64)
    return type.basetype == SPIRType::Int64 ? fmt::format("std::int64_t({}u)", number)
                                            : fmt::format("std::uint64_t({}u)", number);
  return fmt::format("{}({}u)", vector_name(type.basetype, 1), number);
}

}  // namespace tandem::cpu
