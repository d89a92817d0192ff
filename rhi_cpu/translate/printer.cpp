#include "rhi_cpu/translate/printer.hpp"
#include "rhi/spirv/names.hpp"

#include <algorithm>
#include <unordered_set>

#include <fmt/format.h>

#include "rhi_cpu/translate/names/identifiers.hpp"
#include "rhi_cpu/translate/refusal.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRBlock;
using spirv_cross::SPIRConstant;
using spirv_cross::SPIRFunction;
using spirv_cross::SPIRString;
using spirv_cross::SPIRVariable;

namespace {

/// Functions are inlined into their callers, as a GPU does, so that an invocation stays in registers, until a kernel
/// would have more SPIR-V instructions than this. Beyond it the compiler chooses, within the limits of
/// compile_options.hpp: for twice as many, all of them inlined, g++ takes a minute and more in place of four seconds.
constexpr std::uint64_t inlining_limit = 50'000;

}  // namespace

Printer::Printer(const MarkedModule& module, const std::string& label, const rhi::ShaderReflection& reflection,
                 const TranslateOptions& options)
    : CompilerGLSL(module.words.data(), module.words.size()),
      label_(label),
      reflection_(reflection),
      options_(options),
      marks_{.words = {}, .places = module.places, .loops = module.loops, .depth = module.depth} {}

void Printer::fail(const std::string& what) const { refuse(label_, what); }

std::string Printer::compile() {
  set_up_backend();
  ir.fixup_reserved_names();
  set_up_pointers();
  build_function_control_flow_graphs_and_analyze();
  set_up_names();
  set_up_variables();
  set_up_groups();
  set_up_endings();
  measure_functions();
  if (is_wide()) analyze_uniformity();

  std::uint32_t passes = 0;
  do {
    reset(passes++);
    buffer.reset();
    addresses_.clear();
    payloads_.clear();
    printed_functions_.clear();
    declared_phis_.clear();
    print_module();
  } while (is_forcing_recompilation());
  return buffer.str();
}

void Printer::set_up_backend() {
  options.version = 460;
  options.es = false;  // that a module was ESSL would bring words of precision
  options.vulkan_semantics = true;
  options.force_recompile_max_debug_iterations = 256;
  backend.float_literal_suffix = true;
  backend.double_literal_suffix = false;
  backend.uint32_t_literal_suffix = true;
  backend.long_long_literal_suffix = true;
  backend.int16_t_literal_suffix = "";
  backend.uint16_t_literal_suffix = "";
  backend.support_64bit_switch = true;
  backend.support_precise_qualifier = false;
  backend.allow_precision_qualifiers = false;
  backend.requires_relaxed_precision_analysis = false;
  backend.can_return_array = true;
}

void Printer::set_up_names() {
  for (std::uint32_t i = 0; i < 3; ++i) workgroup_size_[i] = reflection_.workgroup_size[i];
  ir.for_each_typed_id<SPIRString>([](std::uint32_t, SPIRString& string) { string.str = escaped(string.str); });
  for (auto& [id, meta] : ir.meta)
    if (!meta.decoration.alias.empty()) meta.decoration.alias = identifier(meta.decoration.alias);
  ir.for_each_typed_id<SPIRFunction>([&](std::uint32_t id, SPIRFunction&) {
    const std::string& name = ir.meta[id].decoration.alias;
    ir.meta[id].decoration.alias = id == std::uint32_t(ir.default_entry_point)
                                       ? "entry_point"
                                       : fmt::format("function_{}_{}", name.substr(0, name.find('_')), id);
  });

  // The wide form has names of its own beside the shader's.
  if (is_wide()) {
    const auto rename = [this](std::uint32_t id) {
      std::string& alias = ir.meta[id].decoration.alias;
      alias = (alias.starts_with('_') ? "the" : "the_") + alias;
    };
    ir.for_each_typed_id<SPIRFunction>([&](std::uint32_t, SPIRFunction& function) {
      for (const std::uint32_t id : function.local_variables) rename(id);
      for (const auto& parameter : function.arguments) rename(parameter.id);
    });
  }

  // Constants print by "name" everywhere, in SPIRV-Cross's own code too: scalars and vectors are their own literal,
  // larger ones are globals.
  std::vector<std::uint32_t> constants;
  ir.for_each_typed_id<SPIRConstant>([&](std::uint32_t id, SPIRConstant&) { constants.push_back(id); });
  for (const std::uint32_t id : constants) {
    auto& constant = get<SPIRConstant>(id);
    const Type& type = get<Type>(constant.constant_type);
    if (type.pointer && !is_buffer(type.storage) && type.storage != spv::StorageClassWorkgroup) continue;
    auto& decoration = ir.meta[id].decoration;
    decoration.builtin = false;
    decoration.decoration_flags.clear(spv::DecorationBuiltIn);
    constant.is_used_as_lut = true;
    if (is_array(type) || (type.basetype == Type::Struct && !is_pointer(type))) {
      decoration.alias = fmt::format("constant_{}", id);
      composite_constants_.insert(id);
    } else {
      decoration.alias = constant_text(constant);
    }
  }
}

void Printer::set_up_variables() {
  std::uint32_t any_constant = 0;
  ir.for_each_typed_id<SPIRConstant>([&](std::uint32_t id, SPIRConstant&) { any_constant = id; });
  if (any_constant == 0) {
    any_constant = ir.increase_bound_by(1);
    set<SPIRConstant>(any_constant, 0u);
  }

  // Every Function variable is declared where its function begins, which is what SPIR-V says, instead of where
  // SPIRV-Cross finds its first use. The initialiser that it sees only makes it do so.
  ir.for_each_typed_id<SPIRFunction>([&](std::uint32_t, SPIRFunction& function) {
    const auto assign_where_stored = [](SPIRVariable& variable) {
      variable.loop_variable = false;
      variable.statically_assigned = false;
      variable.remapped_variable = false;
      variable.static_expression = 0;
    };
    for (const std::uint32_t id : function.local_variables) {
      auto& variable = get<SPIRVariable>(id);
      if (variable.initializer)
        initializers_[id] = variable.initializer;
      else
        variable.initializer = any_constant;
      assign_where_stored(variable);
    }
    // SPIRV-Cross takes an array parameter that is stored to once for a table.
    for (const auto& parameter : function.arguments)
      if (auto* variable = maybe_get<SPIRVariable>(parameter.id)) assign_where_stored(*variable);
  });
  ir.for_each_typed_id<SPIRBlock>([](std::uint32_t, SPIRBlock& block) { block.loop_variables.clear(); });

  ir.for_each_typed_id<SPIRVariable>([&](std::uint32_t id, SPIRVariable& variable) {
    if (variable.storage == spv::StorageClassPrivate)
      ir.meta[id].decoration.alias = fmt::format("private_{}_{}", ir.meta[id].decoration.alias, id);
    else if (is_payload(variable.storage) || is_incoming_payload(variable.storage))
      ir.meta[id].decoration.alias = fmt::format("payload_{}", id);
    else if (variable.storage == spv::StorageClassHitAttributeKHR)
      ir.meta[id].decoration.alias = fmt::format("hit_attributes_{}", id);
    else if (variable.storage == spv::StorageClassInput && has_decoration(id, spv::DecorationBuiltIn))
      built_in_types_[get_decoration(id, spv::DecorationBuiltIn)] = pointee(variable.basetype);
    else if (is_buffer(variable.storage) || variable.storage == spv::StorageClassUniformConstant)
      if (ir.meta[id].decoration.decoration_flags.get(spv::DecorationBinding))
        ir.meta[id].decoration.alias = fmt::format("block_{}", id);
  });
}

std::vector<std::uint32_t> Printer::live_blocks(std::uint32_t function) const {
  // Specialisation constants are constants by now, so what a feature would need is behind a branch that is never taken.
  std::vector<std::uint32_t> found{get<SPIRFunction>(function).entry_block};
  std::unordered_set<std::uint32_t> known(found.begin(), found.end());
  const auto visit = [&](std::uint32_t block) {
    if (block != 0 && known.insert(block).second) found.push_back(block);
  };
  for (std::size_t i = 0; i < found.size(); ++i) {
    const SPIRBlock& block = get<SPIRBlock>(found[i]);
    switch (block.terminator) {
      case SPIRBlock::Direct:
        visit(block.next_block);
        break;
      case SPIRBlock::Select:
        if (const auto* condition = maybe_get<SPIRConstant>(block.condition)) {
          visit(condition->scalar() != 0 ? block.true_block : block.false_block);
        } else {
          visit(block.true_block);
          visit(block.false_block);
        }
        break;
      case SPIRBlock::MultiSelect:
        visit(block.default_block);
        for (const auto& each : get_case_list(block)) visit(each.block);
        break;
      default:
        break;
    }
  }
  return found;
}

void Printer::measure_functions() {
  // SPIR-V forbids recursion, so this ends.
  const auto measure = [&](const auto& self, std::uint32_t id) -> std::uint64_t {
    if (const auto known = inlined_size_.find(id); known != inlined_size_.end()) return known->second;
    std::uint64_t size = 0;
    for (const std::uint32_t block : live_blocks(id)) {
      for (const auto& instruction : get<SPIRBlock>(block).ops) {
        ++size;
        if (instruction.op == spv::OpLine) has_line_numbers_ = true;
        if (instruction.op == spv::OpFunctionCall)
          size = std::min(size + self(self, view(instruction).operand(0)), 2 * inlining_limit);
      }
    }
    return inlined_size_[id] = size;
  };
  measure(measure, ir.default_entry_point);
  options.emit_line_directives = has_line_numbers_;
}

void Printer::print_module() {
  // The functions are printed first: what they use decides which structs and constants there are.
  const auto printed = [this](const auto& print) {
    buffer.reset();
    print();
    return buffer.str();
  };
  const std::string functions = printed([this] {
    if (is_wide())
      print_wide_functions(ir.default_entry_point);
    else
      emit_function(get<SPIRFunction>(ir.default_entry_point), spirv_cross::Bitset());
  });
  const std::string constants = printed([this] { print_constants(); });
  const std::string memory = printed([this] { print_struct_memory_functions(); });
  const std::string group = needs_group() ? printed([this] { print_group(); }) : "";
  const std::string members = printed([this] { print_members(); });
  buffer.reset();
  if (is_wide()) statement("#define TANDEM_LANES ", options_.lanes);
  statement("#include \"rhi_cpu/kernel/", is_wide() ? "wide/wide.hpp" : "kernel.hpp", "\"");
  if (has_halves()) statement("#include \"rhi_cpu/kernel/", is_wide() ? "wide/halves.hpp" : "half.hpp", "\"");
  if (samples_) statement("#include \"rhi_cpu/kernel/", is_wide() ? "wide/" : "", "sampling.hpp\"");
  if (options_.robust) statement("#include \"rhi_cpu/kernel/robust.hpp\"");
  if (options_.watched) statement("#include \"rhi_cpu/kernel/watch.hpp\"");
  if (needs_group()) statement("#include \"rhi_cpu/kernel/workgroups.hpp\"");
  if (!shared_offsets_.empty()) statement("#include \"rhi_cpu/kernel/wide/shared.hpp\"");
  if (is_wide() && uses_subgroups_)
    statement("#include \"rhi_cpu/kernel/wide/together.hpp\"");
  else if (needs_lanes())
    statement("#include \"rhi_cpu/kernel/lanes.hpp\"");
  else if (uses_subgroups_)
    statement("#include \"rhi_cpu/kernel/subgroups.hpp\"");
  statement("");
  statement("namespace {");
  statement("");
  statement("namespace k = tandem::kernel;");
  statement("");
  statement(struct_declarations_, constants, memory, group, members, functions, "};");
  statement("");
  if (is_traced())
    print_shader_call();
  else if (needs_group())
    print_group_run();
  else
    print_run();
  print_info();
}

const rhi::ShaderBinding* Printer::binding_of(std::uint32_t variable) const {
  const std::uint32_t set = get_decoration(variable, spv::DecorationDescriptorSet);
  const std::uint32_t binding = get_decoration(variable, spv::DecorationBinding);
  for (const rhi::ShaderBinding& each : reflection_.bindings)
    if (each.set == set && each.binding == binding) return &each;
  return nullptr;
}

std::uint32_t Printer::first_resource_of(std::uint32_t variable) const {
  const rhi::ShaderBinding* binding = binding_of(variable);
  std::uint32_t first = 0;
  for (const rhi::ShaderBinding& each : reflection_.bindings) {
    if (&each == binding) break;
    first += std::max(each.count, 1u);  // an array without a length is behind one resource
  }
  return first;
}

void Printer::print_constants() {
  std::vector<std::uint32_t> ids(composite_constants_.begin(), composite_constants_.end());
  std::sort(ids.begin(), ids.end());
  for (const std::uint32_t id : ids) {
    const auto& constant = get<SPIRConstant>(id);
    const std::string type = type_name(constant.constant_type);
    statement("const ", type, " constant_", id, " = ", constant_initializer(constant), ";");
  }
  statement("");
}

void Printer::emit_function_prototype(SPIRFunction& function, const spirv_cross::Bitset&) {
  const bool is_entry = std::uint32_t(function.self) == std::uint32_t(ir.default_entry_point);
  processing_entry_point = is_entry;
  local_variable_names = resource_names;
  const bool inlined = inlined_size_[ir.default_entry_point] <= inlining_limit;
  std::string parameters;
  for (auto& parameter : function.arguments) {
    add_local_variable_name(parameter.id);
    if (auto* variable = maybe_get<SPIRVariable>(parameter.id)) variable->parameter = &parameter;
    const Type& type = get<Type>(parameter.type);
    if (!parameters.empty()) parameters += ", ";
    if (!is_pointer(type)) {
      parameters += type_name(parameter.type) + " " + to_name(parameter.id);
    } else if (is_in_memory(type.storage)) {
      if (get<Type>(pointee(parameter.type)).columns > 1) fail("a pointer to a matrix in a buffer as parameter");
      const bool is_constant =
          type.storage == spv::StorageClassPushConstant || type.storage == spv::StorageClassShaderRecordBufferKHR;
      parameters += (is_constant ? "const std::byte* " : "std::byte* ") + to_name(parameter.id);
      addresses_[parameter.id] = {.bytes = to_name(parameter.id), .resource = ""};
    } else {
      const std::uint32_t target = pointee(parameter.type);
      const bool is_descriptor = type.storage == spv::StorageClassUniformConstant;
      parameters += (is_descriptor             ? descriptor_parameter(get<Type>(target))
                     : is_shared_pointer(type) ? type_name(target) + "*"
                                               : type_name(target) + "&") +
                    " " + to_name(parameter.id);
    }
  }
  statement(inlined || is_entry ? "[[gnu::always_inline]] " : "", "inline ", type_name(function.return_type), " ",
            to_name(function.self), "(", parameters, ")");
}

std::string Printer::variable_decl(const Type& type, const std::string& name, std::uint32_t) {
  return type_name(type) + " " + name;
}

std::string Printer::variable_decl(const SPIRVariable& variable) {
  std::uint32_t type = variable.basetype;
  // A variable that SPIRV-Cross made for an OpPhi has the type of its value, which may be a buffer reference.
  if (is_pointer(get<Type>(type)) && get<Type>(type).storage == variable.storage) type = pointee(type);
  std::string initial = is_opaque(get<Type>(type)) ? "" : "{}";
  if (const auto initializer = initializers_.find(variable.self); initializer != initializers_.end())
    initial = " = " + value(initializer->second);
  return type_name(type) + " " + to_name(variable.self) + initial;
}

std::string Printer::builtin_to_glsl(spv::BuiltIn builtin, spv::StorageClass) {
  if (is_traced()) {
    const auto type = built_in_types_.find(builtin);
    if (type == built_in_types_.end()) fail("built-in " + rhi::built_in_name(builtin));
    return fmt::format("{}({})", type_name(type->second), traced_built_in(builtin));
  }
  switch (builtin) {
    case spv::BuiltInNumWorkgroups:
      return "built_in_NumWorkgroups";
    case spv::BuiltInWorkgroupId:
      return "built_in_WorkgroupId";
    case spv::BuiltInLocalInvocationId:
      return "built_in_LocalInvocationId";
    case spv::BuiltInGlobalInvocationId:
      return "built_in_GlobalInvocationId";
    case spv::BuiltInLocalInvocationIndex:
      return "built_in_LocalInvocationIndex";
    default:
      if (const std::string text = subgroup_built_in(builtin); !text.empty())
        return is_wide() ? text : fmt::format("{}({})", type_name(built_in_types_.at(builtin)), text);
      fail("built-in " + rhi::built_in_name(builtin));
  }
}

}  // namespace tandem::cpu
