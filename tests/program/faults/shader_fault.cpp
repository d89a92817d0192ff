#include "tests/program/faults/shader_fault.hpp"

#include <stdexcept>
#include <utility>

#include "tests/faults/shader_edits.hpp"

namespace tandem::test {
namespace {

using Edit = SpirvModule::Edit;

/// What the instruction gives is changed.
Edit changed(std::function<std::uint32_t(CodeWriter&, std::uint32_t)> change) {
  return [change = std::move(change)](Instruction instruction, CodeWriter& code) {
    code.put_changed(std::move(instruction), [&](std::uint32_t value) { return change(code, value); });
  };
}

Edit moved(std::int32_t ulp) {
  return changed([ulp](CodeWriter& code, std::uint32_t value) { return moved_by_ulp(code, value, ulp); });
}

Edit scaled_by(float factor) {
  return changed([factor](CodeWriter& code, std::uint32_t value) { return scaled(code, value, factor); });
}

Edit plus(std::uint32_t added) {
  return changed([added](CodeWriter& code, std::uint32_t value) {
    SpirvModule& module = code.module();
    return code.value(spv::OpIAdd, module.type_of(value), {value, module.constant(added)});
  });
}

/// Operands are swapped; they count from the first behind the type and the result.
Edit swapped(std::size_t first, std::size_t second) {
  return [=](Instruction instruction, CodeWriter& code) {
    std::swap(instruction.operands.at(2 + first), instruction.operands.at(2 + second));
    code.put(std::move(instruction));
  };
}

Edit with_opcode(spv::Op op) {
  return [op](Instruction instruction, CodeWriter& code) {
    instruction.opcode = op;
    code.put(std::move(instruction));
  };
}

/// An operand is another: of all operands of the instruction, with type and result.
Edit with_operand(std::size_t operand, std::uint32_t value, bool is_constant) {
  return [=](Instruction instruction, CodeWriter& code) {
    instruction.operands.at(operand) = is_constant ? code.module().constant(value) : value;
    code.put(std::move(instruction));
  };
}

/// The result is an operand as it is. @param operand of all, with type and result
Edit copied(std::size_t operand) {
  return [=](Instruction instruction, CodeWriter& code) {
    code.put({spv::OpCopyObject,
              {instruction.operands.at(0), instruction.operands.at(1), instruction.operands.at(operand)}});
  };
}

const Edit left_out = [](const Instruction&, CodeWriter&) {};

/// Behind OpSelectionMerge: the targets are swapped.
const Edit other_branch = [](Instruction instruction, CodeWriter& code) {
  std::swap(instruction.operands.at(1), instruction.operands.at(2));
  code.put(std::move(instruction));
};

}  // namespace

std::vector<ShaderFault> shader_faults() {
  const Edit swapped_pair = changed([](CodeWriter& code, std::uint32_t value) {
    return code.value(spv::OpVectorShuffle, code.module().type_of(value), {value, value, 1, 0});
  });
  const Edit matrix_from_the_left = [](Instruction instruction, CodeWriter& code) {
    instruction.opcode = spv::OpVectorTimesMatrix;
    std::swap(instruction.operands.at(2), instruction.operands.at(3));
    code.put(std::move(instruction));
  };
  return {
      {"sqrt is 16 ulp off", "floats", 6, spv::OpExtInst, GLSLstd450Sqrt, moved(16)},
      {"a subtraction has its operands swapped", "floats", 7, spv::OpFSub, 0, swapped(0, 1)},
      {"a product is 4 ulp off", "floats", 8, spv::OpFMul, 0, moved(4)},
      {"a quotient is 9 ulp off", "floats", 9, spv::OpFDiv, 0, moved(9)},
      {"clamp does not clamp", "floats", 10, spv::OpExtInst, GLSLstd450FClamp, copied(4)},
      {"exp2 is coarse", "floats", 11, spv::OpExtInst, GLSLstd450Exp2, scaled_by(1.0005f)},
      {"inversesqrt is coarse", "floats", 12, spv::OpExtInst, GLSLstd450InverseSqrt, scaled_by(1.0001f)},
      {"a negation is lost", "floats", 13, spv::OpFNegate, 0, copied(2)},
      {"smoothstep ends late", "floats", 14, spv::OpExtInst, GLSLstd450SmoothStep, scaled_by(0.99f)},
      {"min is max", "floats", 20, spv::OpExtInst, GLSLstd450FMin, with_operand(3, GLSLstd450FMax, false)},
      {"equal is not equal", "floats", 21, spv::OpFOrdEqual, 0, with_opcode(spv::OpFOrdNotEqual)},
      {"a store is lost", "floats", 22, spv::OpStore, 0, left_out},
      {"mix takes 1 - a", "floats", 23, spv::OpExtInst, GLSLstd450FMix, swapped(2, 3)},
      {"a shift is one too far", "integers", 6, spv::OpShiftRightLogical, 0, with_operand(3, 3, true)},
      {"a product has another lowest bit", "integers", 7, spv::OpIMul, 0, plus(1)},
      {"or is exclusive", "integers", 8, spv::OpBitwiseOr, 0, with_opcode(spv::OpBitwiseXor)},
      {"a conversion rounds up", "integers", 14, spv::OpConvertFToS, 0, plus(1)},
      {"a shift brings no sign", "integers", 15, spv::OpShiftRightArithmetic, 0, with_opcode(spv::OpShiftRightLogical)},
      {"a bit field is a bit too wide", "integers", 16, spv::OpBitFieldUExtract, 0, with_operand(4, 8, true)},
      {"a remainder is a quotient", "integers", 17, spv::OpUMod, 0, with_opcode(spv::OpUDiv)},
      {"findMSB counts from 1", "integers", 18, spv::OpExtInst, GLSLstd450FindUMsb, plus(1)},
      {"bitCount misses a bit", "integers", 20, spv::OpBitCount, 0, plus(0xffffffffu)},
      {"shared memory is read as it was", "shared", 12, spv::OpLoad, 0,
       [](const Instruction& instruction, CodeWriter& code) {
         code.put(
             {spv::OpCopyObject, {instruction.operands.at(0), instruction.operands.at(1), code.module().constant(0u)}});
       },
       1},
      {"an atomic of shared memory is missed", "shared", 13, spv::OpAtomicUMax, 0, with_operand(5, 0, true)},
      {"an atomic of a buffer is missed", "shared", 17, spv::OpAtomicIAdd, 0, with_operand(5, 0, true)},
      {"a matrix is multiplied from the left", "control", 7, spv::OpMatrixTimesVector, 0, matrix_from_the_left},
      {"a swizzle has another order", "control", 8, spv::OpVectorShuffle, 0, with_operand(4, 1, false)},
      {"dot misses something", "control", 17, spv::OpDot, 0, scaled_by(0.999f)},
      {"greater is greater or equal, and less", "control", 18, spv::OpFOrdGreaterThan, 0,
       with_opcode(spv::OpFOrdLessThan)},
      {"and is or", "control", 19, spv::OpLogicalAnd, 0, with_opcode(spv::OpLogicalOr)},
      {"a select under a divergent branch takes the other", "control", 24, spv::OpSelect, 0, swapped(1, 2)},
      {"a branch goes the other way", "control", 19, spv::OpBranchConditional, 0, other_branch},
      {"the barycentrics are swapped", "rays", 16, spv::OpRayQueryGetIntersectionBarycentricsKHR, 0, swapped_pair},
      {"t is coarse", "rays", 15, spv::OpRayQueryGetIntersectionTKHR, 0, scaled_by(1.001f)},
      {"primitives count from 1", "rays", 17, spv::OpRayQueryGetIntersectionPrimitiveIndexKHR, 0, plus(1)},
      {"an instance has another custom index", "rays", 18, spv::OpRayQueryGetIntersectionInstanceCustomIndexKHR, 0,
       plus(10)},
  };
}

std::size_t place_of(const ShaderFault& fault, const program::Module& module) {
  std::size_t skipped = 0;
  for (std::size_t i = module.first_function; i < module.instructions.size(); ++i) {
    const program::Instruction& instruction = module.instructions[i];
    if (instruction.line.line != fault.line || static_cast<int>(instruction.op) != static_cast<int>(fault.op)) continue;
    if (fault.op == spv::OpExtInst && instruction.words[4] != fault.function) continue;
    if (skipped++ == fault.skipped) return i;
  }
  throw std::runtime_error(fault.name + ": the shader has no such instruction");
}

DeviceEdits edits_of(const ShaderFault& fault, const program::Module& module) {
  const program::Instruction wrong = module.instructions[place_of(fault, module)];
  // What has no result is known by an id that recording leaves alone: where it stores, or where it goes.
  const std::size_t known_by = fault.op == spv::OpStore ? 1 : 2;
  DeviceEdits edits;
  edits.shader = [edit = fault.edit, op = fault.op, wrong, known_by](SpirvModule& edited, rhi::ShaderStage) {
    bool found = false;
    edited.edit_functions([&](Instruction instruction, CodeWriter& code) {
      const bool is_it = instruction.opcode == op &&
                         (wrong.result != 0 ? instruction.result() == wrong.result
                                            : instruction.operands.at(known_by - 1) == wrong.words.at(known_by));
      found = found || is_it;
      if (is_it)
        edit(std::move(instruction), code);
      else
        code.put(std::move(instruction));
    });
    return found;
  };
  return edits;
}

}  // namespace tandem::test
