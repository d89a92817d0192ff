#include "program/cause/environment.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

#include <spirv_cross/GLSL.std.450.h>

namespace tandem::program {
namespace {

bool is_one_of(auto value, std::initializer_list<decltype(value)> list) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

/// What only moves bits never flushes: the list of "must not flush denormalized values".
bool never_flushes(spv::Op op) {
  return is_one_of(op, {spv::OpBitcast, spv::OpPhi, spv::OpSelect, spv::OpVectorExtractDynamic,
                        spv::OpVectorInsertDynamic, spv::OpVectorShuffle, spv::OpCompositeConstruct,
                        spv::OpCompositeExtract, spv::OpCompositeInsert, spv::OpCopyObject, spv::OpCopyLogical});
}

/// The instructions that "must respect the DenormPreserve execution mode".
bool respects_denorm_preserve(spv::Op op, std::uint32_t glsl) {
  return is_one_of(op, {spv::OpTranspose,
                        spv::OpFConvert,
                        spv::OpFNegate,
                        spv::OpFAdd,
                        spv::OpFSub,
                        spv::OpFMul,
                        spv::OpVectorTimesScalar,
                        spv::OpMatrixTimesScalar,
                        spv::OpVectorTimesMatrix,
                        spv::OpMatrixTimesVector,
                        spv::OpMatrixTimesMatrix,
                        spv::OpOuterProduct,
                        spv::OpDot,
                        spv::OpFOrdEqual,
                        spv::OpFUnordEqual,
                        spv::OpFOrdNotEqual,
                        spv::OpFUnordNotEqual,
                        spv::OpFOrdLessThan,
                        spv::OpFUnordLessThan,
                        spv::OpFOrdGreaterThan,
                        spv::OpFUnordGreaterThan,
                        spv::OpFOrdLessThanEqual,
                        spv::OpFUnordLessThanEqual,
                        spv::OpFOrdGreaterThanEqual,
                        spv::OpFUnordGreaterThanEqual}) ||
         is_one_of(glsl, {GLSLstd450FAbs, GLSLstd450FSign, GLSLstd450Radians, GLSLstd450Degrees, GLSLstd450FMin,
                          GLSLstd450FMax, GLSLstd450FClamp, GLSLstd450FMix, GLSLstd450Fma, GLSLstd450PackHalf2x16,
                          GLSLstd450PackDouble2x32, GLSLstd450UnpackHalf2x16, GLSLstd450UnpackDouble2x32,
                          GLSLstd450NMin, GLSLstd450NMax, GLSLstd450NClamp});
}

/// The instructions that "must respect the DenormFlushToZero execution mode".
bool respects_denorm_flush(spv::Op op, std::uint32_t glsl) {
  return is_one_of(op,
                   {spv::OpFConvert, spv::OpFNegate, spv::OpFAdd, spv::OpFSub, spv::OpFMul, spv::OpFDiv, spv::OpFRem,
                    spv::OpFMod, spv::OpVectorTimesScalar, spv::OpMatrixTimesScalar, spv::OpVectorTimesMatrix,
                    spv::OpMatrixTimesVector, spv::OpMatrixTimesMatrix, spv::OpOuterProduct, spv::OpDot}) ||
         (glsl != 0 && !is_one_of(glsl, {GLSLstd450FSign, GLSLstd450Frexp, GLSLstd450FrexpStruct, GLSLstd450Ldexp,
                                         GLSLstd450PackDouble2x32}));
}

/// The instructions that "must respect the SignedZeroInfNanPreserve execution mode".
bool respects_specials(spv::Op op) {
  return never_flushes(op) ||
         is_one_of(op, {spv::OpTranspose, spv::OpFConvert, spv::OpFNegate, spv::OpFAdd, spv::OpFSub, spv::OpFMul});
}

bool has_mode(const Module& module, spv::ExecutionMode mode, std::uint32_t width) {
  return std::any_of(module.instructions.begin(),
                     module.instructions.begin() + static_cast<std::ptrdiff_t>(module.first_global),
                     [&](const Instruction& instruction) {
                       return instruction.op == spv::OpExecutionMode &&
                              instruction.words[2] == static_cast<std::uint32_t>(mode) && instruction.words[3] == width;
                     });
}

}  // namespace

bool is_decorated(const Module& module, std::uint32_t id, spv::Decoration decoration) {
  if (id == 0) return false;
  return std::any_of(module.instructions.begin(),
                     module.instructions.begin() + static_cast<std::ptrdiff_t>(module.first_global),
                     [&](const Instruction& instruction) {
                       return instruction.op == spv::OpDecorate && instruction.words[1] == id &&
                              instruction.words[2] == static_cast<std::uint32_t>(decoration);
                     });
}

std::uint32_t glsl_instruction(const Module& module, const Instruction& instruction) {
  if (instruction.op != spv::OpExtInst) return 0;
  const Instruction& set = definition(module, instruction.words[3]);
  // "GLSL.std.450" as the words of an OpExtInstImport.
  constexpr std::array<std::uint32_t, 4> name = {0x4c534c47, 0x6474732e, 0x3035342e, 0};
  const bool is_glsl = set.words.size() == 2 + name.size() && std::equal(name.begin(), name.end(), &set.words[2]);
  return is_glsl ? instruction.words[4] : 0;
}

Rules rules_of(const Module& module, const Instruction& instruction, std::uint32_t width) {
  const std::uint32_t glsl = glsl_instruction(module, instruction);
  const auto mode = [&](spv::ExecutionMode each) { return has_mode(module, each, width); };
  Rules rules{.format = format_of(width)};
  if (mode(spv::ExecutionModeRoundingModeRTE)) rules.rounding = Rounding::to_nearest;
  if (mode(spv::ExecutionModeRoundingModeRTZ)) rules.rounding = Rounding::to_zero;
  rules.may_flush = !never_flushes(instruction.op) &&
                    !(mode(spv::ExecutionModeDenormPreserve) && respects_denorm_preserve(instruction.op, glsl));
  rules.must_flush = mode(spv::ExecutionModeDenormFlushToZero) && respects_denorm_flush(instruction.op, glsl);
  rules.keeps_specials = mode(spv::ExecutionModeSignedZeroInfNanPreserve) && respects_specials(instruction.op);
  rules.relaxed = width == 32 && is_decorated(module, instruction.result, spv::DecorationRelaxedPrecision);
  if (rules.relaxed) {
    rules.format = format_of(16);
    rules.may_flush = true;
    rules.must_flush = false;
  }
  return rules;
}

}  // namespace tandem::program
