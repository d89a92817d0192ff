#include <fmt/format.h>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::Instruction;

void Printer::emit_instruction(const Instruction& instruction) {
  const std::uint32_t* ops = stream(instruction);
  const auto op = static_cast<spv::Op>(instruction.op);
  const std::uint32_t length = instruction.length;
  switch (op) {
    case spv::OpNop:
    case spv::OpNoLine:
      return;
    case spv::OpLine:
      return emit_line_directive(ops[0], ops[1]);
    case spv::OpLoad:
      return print_load(ops);
    case spv::OpStore:
      return print_store(ops[0], value(ops[1]));
    case spv::OpCopyMemory:
      if (is_buffer_pointer(ops[1]))
        return print_store(ops[0], load_text(pointee(expression_type_id(ops[1])), address_of(ops[1])));
      return print_store(ops[0], value(ops[1]));
    case spv::OpAccessChain:
    case spv::OpInBoundsAccessChain:
      return print_access_chain(ops, length);
    case spv::OpArrayLength:
      return print_array_length(ops);
    case spv::OpMemoryBarrier:
      statement("k::memory_barrier();");
      return;
    case spv::OpFunctionCall:
      return print_call(ops, length);
    case spv::OpCompositeConstruct:
    case spv::OpCompositeExtract:
    case spv::OpCompositeInsert:
    case spv::OpVectorExtractDynamic:
    case spv::OpVectorInsertDynamic:
    case spv::OpVectorShuffle:
    case spv::OpCopyObject:
    case spv::OpCopyLogical:
      return print_composite(op, ops, length);
    case spv::OpExtInst:
      return print_extended(ops, length);
    default:
      break;
  }
  const bool atomic = (op >= spv::OpAtomicLoad && op <= spv::OpAtomicXor) || op == spv::OpAtomicFAddEXT;
  if (atomic) return print_atomic(op, ops);
  if (op >= spv::OpTraceRayKHR && op <= spv::OpTerminateRayKHR) return print_ray_tracing(op, ops);
  if (op == spv::OpReportIntersectionKHR) return print_ray_tracing(op, ops);
  if (op >= spv::OpRayQueryInitializeKHR) return print_ray_query(op, ops);
  if (print_image(op, ops, length) || print_arithmetic(op, ops) || print_relation(op, ops) ||
      print_conversion(op, ops) || print_bits(op, ops) || print_matrix(op, ops))
    return;
  fail(fmt::format("SPIR-V opcode {}", static_cast<std::uint32_t>(op)));
}

}  // namespace tandem::cpu
