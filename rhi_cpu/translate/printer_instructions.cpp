#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "rhi/spirv/names.hpp"
#include "rhi_cpu/translate/prepare.hpp"
#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

Printer::PrintFunction Printer::by_hand(spv::Op op) {
  struct Row {
    spv::Op op;
    PrintFunction print;
  };
  static constexpr Row rows[] = {
      {spv::OpNop, &Printer::print_nothing},
      {spv::OpNoLine, &Printer::print_nothing},
      {spv::OpLine, &Printer::print_line},
      {spv::OpFunctionCall, &Printer::print_call},
      {spv::OpExtInst, &Printer::print_extended},
      // memory
      {spv::OpLoad, &Printer::print_load},
      {spv::OpStore, &Printer::print_store},
      {spv::OpCopyMemory, &Printer::print_copy_memory},
      {spv::OpAccessChain, &Printer::print_access_chain},
      {spv::OpInBoundsAccessChain, &Printer::print_access_chain},
      {spv::OpArrayLength, &Printer::print_array_length},
      {spv::OpAtomicLoad, &Printer::print_atomic_load},
      {spv::OpAtomicStore, &Printer::print_atomic_store},
      {spv::OpAtomicCompareExchange, &Printer::print_compare_exchange},
      {spv::OpMemoryBarrier, &Printer::print_memory_barrier},
      {spv::OpControlBarrier, &Printer::print_control_barrier},
      {spv::OpReadClockKHR, &Printer::print_clock},
      // pointers
      {spv::OpPtrAccessChain, &Printer::print_pointer_access_chain},
      {spv::OpPtrEqual, &Printer::print_pointer_relation},
      {spv::OpPtrNotEqual, &Printer::print_pointer_relation},
      {spv::OpPtrDiff, &Printer::print_pointer_relation},
      // images
      {spv::OpImageRead, &Printer::print_image_read},
      {spv::OpImageWrite, &Printer::print_image_write},
      {spv::OpImageQuerySize, &Printer::print_image_size},
      {spv::OpImageQuerySizeLod, &Printer::print_image_size},
      {spv::OpImageQueryLevels, &Printer::print_level_count},
      {spv::OpImageTexelPointer, &Printer::print_texel_pointer},
      {spv::OpSampledImage, &Printer::print_sampled_image},
      {spv::OpImage, &Printer::print_image_of},
      {spv::OpImageFetch, &Printer::print_fetch},
      {spv::OpImageSampleExplicitLod, &Printer::print_sample},
      {spv::OpImageSampleProjExplicitLod, &Printer::print_sample},
      {spv::OpImageSampleDrefExplicitLod, &Printer::print_sample_compare},
      {spv::OpImageSampleProjDrefExplicitLod, &Printer::print_sample_compare},
      {spv::OpImageGather, &Printer::print_gather},
      {spv::OpImageDrefGather, &Printer::print_gather},
      // composites
      {spv::OpCompositeConstruct, &Printer::print_construct},
      {spv::OpCompositeExtract, &Printer::print_extract},
      {spv::OpCompositeInsert, &Printer::print_insert},
      {spv::OpVectorExtractDynamic, &Printer::print_extract_dynamic},
      {spv::OpVectorInsertDynamic, &Printer::print_insert_dynamic},
      {spv::OpVectorShuffle, &Printer::print_shuffle},
      {spv::OpCopyObject, &Printer::print_copy},
      {spv::OpCopyLogical, &Printer::print_copy_logical},
      // bits
      {spv::OpBitcast, &Printer::print_bitcast},
      {spv::OpConvertUToPtr, &Printer::print_bitcast},
      {spv::OpConvertPtrToU, &Printer::print_bitcast},
      {spv::OpBitCount, &Printer::print_bit_count},
      {spv::OpSDot, &Printer::print_integer_dot},
      {spv::OpUDot, &Printer::print_integer_dot},
      {spv::OpSUDot, &Printer::print_integer_dot},
      {spv::OpSDotAccSat, &Printer::print_integer_dot},
      {spv::OpUDotAccSat, &Printer::print_integer_dot},
      {spv::OpSUDotAccSat, &Printer::print_integer_dot},
      // promises
      {spv::OpExpectKHR, &Printer::print_copy},
      {spv::OpAssumeTrueKHR, &Printer::print_nothing},
      // rays
      {spv::OpConvertUToAccelerationStructureKHR, &Printer::print_structure_at},
      {spv::OpTraceRayKHR, &Printer::print_trace_ray},
      {spv::OpExecuteCallableKHR, &Printer::print_execute_callable},
      {spv::OpReportIntersectionKHR, &Printer::print_report_intersection},
      {spv::OpIgnoreIntersectionKHR, &Printer::print_ignore_intersection},
      {spv::OpTerminateRayKHR, &Printer::print_terminate_ray},
  };
  static_assert(
      std::none_of(std::begin(rows), std::end(rows), [](const Row& row) { return find_operation(row.op) != nullptr; }),
      "an instruction is printed in one way");
  for (const Row& row : rows)
    if (row.op == op) return row.print;
  return is_subgroup_operation(op) ? &Printer::print_subgroup_operation : nullptr;
}

bool Printer::prints(spv::Op op) { return find_operation(op) != nullptr || by_hand(op) != nullptr; }

Instruction Printer::view(const spirv_cross::Instruction& instruction) const {
  return {static_cast<spv::Op>(instruction.op), {stream(instruction), instruction.length}};
}

void Printer::emit_instruction(const spirv_cross::Instruction& instruction) { print_instruction(view(instruction)); }

void Printer::print_instruction(const Instruction& i) {
  if (i.op() == loop_mark) return print_look();
  if (i.op() == place_mark || i.op() == round_mark || i.op() == loop_declaration) return print_mark(i);
  if (const Operation* operation = find_operation(i.op()))
    print_operation(i, *operation);
  else if (const PrintFunction print = by_hand(i.op()))
    (this->*print)(i);
  else
    fail(rhi::instruction_name(i.op(), i.words()));
  is_marked_ = false;
}

void Printer::print_line(const Instruction& i) { emit_line_directive(i.operand(0), i.operand(1)); }

void Printer::print_memory_barrier(const Instruction&) { statement("k::memory_barrier();"); }

void Printer::print_clock(const Instruction& i) {
  define(i, fmt::format("k::bit_cast<{}>(k::read_clock())", type_name(i.result_type())));
}

}  // namespace tandem::cpu
