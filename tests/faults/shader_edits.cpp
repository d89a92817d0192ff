#include "tests/faults/shader_edits.hpp"

#include <utility>

namespace tandem::test {
namespace {

/// An edit of every instruction of functions of one name, or of all when `function` is "".
using InstructionEdit = std::function<bool(Instruction& instruction, CodeWriter& code)>;

/// @param edit false where it wrote nothing; the instruction then stays
ShaderEdit edit_where(std::string function, InstructionEdit edit) {
  return [function = std::move(function), edit = std::move(edit)](SpirvModule& module, rhi::ShaderStage) {
    bool changed = false;
    const SpirvModule::Edit each = [&](Instruction instruction, CodeWriter& code) {
      if (edit(instruction, code))
        changed = true;
      else
        code.put(std::move(instruction));
    };
    if (function.empty())
      module.edit_functions(each);
    else
      module.edit_function(function, each);
    return changed;
  };
}

}  // namespace

ShaderEdit edited_results(std::string function, spv::Op opcode, ValueEdit edit) {
  return edit_where(std::move(function), [opcode, edit = std::move(edit)](Instruction& instruction, CodeWriter& code) {
    if (instruction.opcode != opcode) return false;
    code.put_changed(instruction, [&](std::uint32_t result) { return edit(code, result); });
    return true;
  });
}
ShaderEdit edited_results(spv::Op opcode, ValueEdit edit) { return edited_results("", opcode, std::move(edit)); }

ShaderEdit edited_returns(std::string function, ValueEdit edit) {
  return edited_operand(std::move(function), spv::OpReturnValue, 0, std::move(edit));
}

ShaderEdit edited_calls(std::string function, std::string callee, ValueEdit edit) {
  return edit_where(std::move(function), [callee = std::move(callee), edit = std::move(edit)](Instruction& instruction,
                                                                                              CodeWriter& code) {
    if (instruction.opcode != spv::OpFunctionCall || !code.module().has_name(instruction.operands[2], callee))
      return false;
    code.put_changed(instruction, [&](std::uint32_t result) { return edit(code, result); });
    return true;
  });
}

ShaderEdit edited_builtin(spv::BuiltIn builtin, ValueEdit edit) {
  return edit_where("", [builtin, edit = std::move(edit)](Instruction& instruction, CodeWriter& code) {
    if (instruction.opcode != spv::OpLoad || code.module().builtin_of(instruction.operands[2]) != builtin) return false;
    code.put_changed(instruction, [&](std::uint32_t result) { return edit(code, result); });
    return true;
  });
}

ShaderEdit edited_operand(std::string function, spv::Op opcode, std::size_t index, ValueEdit edit) {
  return edit_where(std::move(function),
                    [opcode, index, edit = std::move(edit)](Instruction& instruction, CodeWriter& code) {
                      if (instruction.opcode != opcode) return false;
                      instruction.operands.at(index) = edit(code, instruction.operands.at(index));
                      code.put(std::move(instruction));
                      return true;
                    });
}
ShaderEdit edited_operand(spv::Op opcode, std::size_t index, ValueEdit edit) {
  return edited_operand("", opcode, index, std::move(edit));
}

ShaderEdit without(spv::Op opcode, spv::Op terminator) {
  return edit_where("", [opcode, terminator](Instruction& instruction, CodeWriter& code) {
    if (instruction.opcode != opcode) return false;
    if (terminator != spv::OpNop) code.put({terminator, {}});
    return true;
  });
}

std::uint32_t moved_by_ulp(CodeWriter& code, std::uint32_t value, std::int32_t steps) {
  SpirvModule& module = code.module();
  const std::uint32_t floats = module.float_type();
  const std::uint32_t bits = code.value(spv::OpBitcast, module.int_type(), {value});
  const std::uint32_t moved_bits = code.value(spv::OpIAdd, module.int_type(), {bits, module.constant(steps)});
  const std::uint32_t moved = code.value(spv::OpBitcast, floats, {moved_bits});
  const std::uint32_t is_zero = code.value(spv::OpFOrdEqual, module.bool_type(), {value, module.constant(0.0f)});
  return code.value(spv::OpSelect, floats, {is_zero, value, moved});
}

std::uint32_t scaled(CodeWriter& code, std::uint32_t value, float scale) {
  return code.value(spv::OpFMul, code.module().float_type(), {value, code.module().constant(scale)});
}

}  // namespace tandem::test
