#include "program/record/mirror.hpp"

#include <algorithm>
#include <array>

namespace tandem::program {
namespace {

bool has_subgroups(const Module& module) {
  return std::ranges::any_of(module.instructions, [](const Instruction& instruction) {
    return instruction.op == spv::OpCapability && instruction.words[1] >= spv::CapabilityGroupNonUniform &&
           instruction.words[1] <= spv::CapabilityGroupNonUniformQuad;
  });
}

/// The variable that is the built-in; 0 where the module has none.
std::uint32_t variable_of(const Module& module, spv::BuiltIn built_in) {
  for (std::size_t i = 0; i < module.first_global; ++i) {
    const std::vector<std::uint32_t>& words = module.instructions[i].words;
    if (module.instructions[i].op == spv::OpDecorate && words[2] == spv::DecorationBuiltIn &&
        words[3] == static_cast<std::uint32_t>(built_in))
      return words[1];
  }
  return 0;
}

}  // namespace

Mirror::Mirror(const Module& module, Globals& globals, spv::ExecutionModel model)
    : is_compute_(model == spv::ExecutionModelGLCompute) {
  if (is_compute_) {
    keeps_workgroups_ = has_subgroups(module);
    size_ = workgroup_size(module, globals);
    counts_ = globals.input(spv::BuiltInNumWorkgroups, globals.uint_vector(3));
    add(module, globals, spv::BuiltInGlobalInvocationId, true);
    add(module, globals, spv::BuiltInWorkgroupId, keeps_workgroups_);
    if (keeps_workgroups_) return;
    add(module, globals, spv::BuiltInLocalInvocationId, false);
    add(module, globals, spv::BuiltInLocalInvocationIndex, false);
  } else {
    counts_ = globals.input(spv::BuiltInLaunchSizeKHR, globals.uint_vector(3));
    add(module, globals, spv::BuiltInLaunchIdKHR, true);
  }
}

void Mirror::add(const Module& module, Globals& globals, spv::BuiltIn built_in, bool is_needed) {
  const bool is_scalar = built_in == spv::BuiltInLocalInvocationIndex;
  const std::uint32_t type = is_scalar ? globals.uint_type() : globals.uint_vector(3);
  if (!is_needed && variable_of(module, built_in) == 0) return;
  const std::uint32_t input = globals.input(built_in, type);
  variables_.emplace(input, globals.variable(spv::StorageClassPrivate, type));
  built_ins_.emplace(input, built_in);
}

std::uint32_t Mirror::in_place_of(std::uint32_t id) const {
  const auto found = variables_.find(id);
  return found == variables_.end() ? id : found->second;
}

std::uint32_t Mirror::workgroup_size(const Module& module, Globals& globals) const {
  std::array<std::uint32_t, 3> size = {1, 1, 1};
  for (std::size_t i = 0; i < module.first_global; ++i) {
    const Instruction& instruction = module.instructions[i];
    const auto value = [&](std::size_t axis) { return instruction.words[3 + axis]; };
    const bool is_literal =
        instruction.op == spv::OpExecutionMode && instruction.words[2] == spv::ExecutionModeLocalSize;
    const bool is_id =
        instruction.op == spv::OpExecutionModeId && instruction.words[2] == spv::ExecutionModeLocalSizeId;
    for (std::size_t axis = 0; axis < 3 && (is_literal || is_id); ++axis)
      size[axis] = is_literal ? value(axis) : definition(module, value(axis)).words[3];
  }
  // A constant that is decorated so goes before the execution mode.
  if (const std::uint32_t decorated = variable_of(module, spv::BuiltInWorkgroupSize); decorated != 0) {
    const Instruction& vector = definition(module, decorated);
    for (std::size_t axis = 0; axis < 3 && vector.op == spv::OpConstantComposite; ++axis)
      size[axis] = definition(module, vector.words[3 + axis]).words[3];
  }
  return globals.constant_vector(size);
}

void Mirror::begin_entry(Code& code) {
  Globals& globals = code.globals();
  const std::uint32_t uint = globals.uint_type(), vector = globals.uint_vector(3);
  const std::uint32_t ones = globals.constant_vector({1, 1, 1});
  const auto mirrored = [&](std::uint32_t count, std::uint32_t id) {
    const std::uint32_t last = code.value(spv::OpISub, vector, {count, ones});
    return code.value(spv::OpISub, vector, {last, id});
  };
  const std::uint32_t counts = code.load(counts_, vector);
  for (const auto& [input, variable] : variables_) {
    const spv::BuiltIn built_in = built_ins_.at(input);
    if (built_in == spv::BuiltInLocalInvocationIndex) {
      std::uint32_t product = globals.constant(1);
      for (std::uint32_t axis = 0; axis < 3; ++axis)
        product = code.value(spv::OpIMul, uint, {product, code.value(spv::OpCompositeExtract, uint, {size_, axis})});
      const std::uint32_t last = code.value(spv::OpISub, uint, {product, globals.constant(1)});
      code.store(variable, code.value(spv::OpISub, uint, {last, code.load(input, uint)}));
      continue;
    }
    const std::uint32_t id = code.load(input, vector);
    std::uint32_t result = 0;
    if (built_in == spv::BuiltInLocalInvocationId) {
      result = mirrored(size_, id);
    } else if (built_in == spv::BuiltInGlobalInvocationId && keeps_workgroups_) {
      // What is left of the workgroup, in the mirrored one.
      const std::uint32_t group = code.value(spv::OpUDiv, vector, {id, size_});
      const std::uint32_t first = code.value(spv::OpIMul, vector, {group, size_});
      const std::uint32_t local = code.value(spv::OpISub, vector, {id, first});
      const std::uint32_t other = code.value(spv::OpIMul, vector, {mirrored(counts, group), size_});
      result = code.value(spv::OpIAdd, vector, {other, local});
    } else if (built_in == spv::BuiltInGlobalInvocationId) {
      result = mirrored(code.value(spv::OpIMul, vector, {counts, size_}), id);
    } else {
      result = mirrored(counts, id);
    }
    code.store(variable, result);
  }
}

}  // namespace tandem::program
