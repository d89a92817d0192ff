#include <fmt/format.h>

#include "rhi/spirv/names.hpp"
#include "rhi_cpu/translate/instructions/extended_instructions.hpp"
#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRExtension;
using spirv_cross::SPIRType;

namespace {

/// OpExtInst has the set and the instruction in front of the instruction's own operands.
constexpr std::size_t first_own_operand = 2;

}  // namespace

void Printer::print_extended(const Instruction& i) {
  if (get<SPIRExtension>(i.operand(0)).ext != SPIRExtension::GLSL) return;  // NonSemantic
  const ExtendedInstruction* extended = find_extended(i.operand(1));
  if (extended == nullptr) fail("extended instruction " + rhi::extended_instruction_name(i.operand(1)));
  switch (extended->shape) {
    case ExtendedShape::bit_search:
      if (type_of(i.operand(first_own_operand)).width != 32) fail("a bit search on other than 32 bits");
      return print_extended_call(i, *extended, SPIRType::Int);
    case ExtendedShape::function:
      return print_extended_call(i, *extended, with_sign(get<Type>(i.result_type()).basetype, extended->sign));
    case ExtendedShape::split_into_pointer:
      return print_split_into_pointer(i, extended->function);
    case ExtendedShape::split_into_struct:
      return print_split_into_struct(i, extended->function);
  }
}

void Printer::print_extended_call(const Instruction& i, const ExtendedInstruction& extended, BaseType base) {
  const std::string arguments = values_with_sign(i, first_own_operand, extended.sign);
  define_as(i, fmt::format("k::{}({})", extended.function, arguments), base);
}

void Printer::print_split_into_pointer(const Instruction& i, const char* function) {
  const std::uint32_t number = i.operand(first_own_operand), pointer = i.operand(first_own_operand + 1);
  if (mode_ == Mode::lane && has_varying_contents(pointer))
    return define(i, fmt::format("[&] {{ {} second{{}}; const auto first = k::{}({}, second); k::set_lane({}, lane, "
                                 "second); return first; }}()",
                                 narrow_name(get<Type>(pointee(expression_type_id(pointer)))), function, value(number),
                                 to_expression(pointer)));
  if (!is_buffer_pointer(pointer))
    return define(i, fmt::format("k::{}({}, {})", function, value(number), place_at(pointer)));
  const std::uint32_t type_id = pointee(expression_type_id(pointer));
  define(i, fmt::format("[&] {{ {} second{{}}; const auto first = k::{}({}, second); {}; return first; }}()",
                        type_name(type_id), function, value(number),
                        guarded_store(type_id, address_of(pointer), "second")));
}

void Printer::print_split_into_struct(const Instruction& i, const char* function) {
  const std::vector<std::string> members = member_names(get<Type>(i.result_type()));
  define(i, type_name(i.result_type()) + "{}");
  statement(fmt::format("{0}.{1} = k::{3}({4}, {0}.{2});", value(i.result()), members[0], members[1], function,
                        value(i.operand(first_own_operand))));
}

}  // namespace tandem::cpu
