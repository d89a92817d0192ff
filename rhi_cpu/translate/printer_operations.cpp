// What operations.hpp says of an instruction, as C++.

#include <algorithm>

#include <fmt/format.h>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRConstant;
using spirv_cross::SPIRType;

std::string Printer::value(std::uint32_t id) {
  const auto address = addresses_.find(id);
  if (address != addresses_.end() && is_buffer_pointer(id)) check_pointer_value(id, address->second);
  if (std::ranges::find(workgroup_variables_, id) != workgroup_variables_.end() && !has_workgroup_blocks_)
    return fmt::format("(&{})", to_name(id));
  const auto* variable = is_wide() ? maybe_get<spirv_cross::SPIRVariable>(id) : nullptr;
  const bool is_phi = variable != nullptr && variable->phi_variable;
  return in_mode(id, is_phi ? fmt::format("v_{}", id) : to_expression(id));
}

std::string Printer::value_as(std::uint32_t id, BaseType base) {
  const Type& type = type_of(id);
  if (type.basetype == base) return value(id);
  return fmt::format("{}({})", numbers_name(base, type.vecsize), value(id));
}

std::string Printer::value_with_sign(std::uint32_t id, Sign sign) {
  return value_as(id, with_sign(type_of(id).basetype, sign));
}

std::string Printer::values_with_sign(const Instruction& i, std::size_t first, Sign sign) {
  std::string text;
  for (std::size_t k = first; k < i.operand_count(); ++k)
    text += (k == first ? "" : ", ") + value_with_sign(i.operand(k), sign);
  return text;
}

void Printer::define(const Instruction& i, const std::string& text) {
  if (is_wide()) return define_wide(i.result_type(), i.result(), text);
  emit_op(i.result_type(), i.result(), text, false);
}

void Printer::define_as(const Instruction& i, const std::string& text, BaseType base) {
  const Type& type = get<Type>(i.result_type());
  // Arithmetic on 8 and 16 bits is done in int by C++.
  const bool promoted = type.vecsize == 1 && type.width < 32 && is_integer(base);
  define(i, type.basetype == base && !promoted ? text : fmt::format("{}({})", type_name(type), text));
}

std::string Printer::lanes_argument() const { return mode_ == Mode::wide ? mask_ + ", " : ""; }

void Printer::print_operation(const Instruction& i, const Operation& operation) {
  switch (operation.shape) {
    case Shape::infix:
      return print_infix(i, operation);
    case Shape::prefix:
      return print_prefix(i, operation);
    case Shape::call:
      return print_function(i, operation);
    case Shape::relation:
      return print_relation(i, operation);
    case Shape::conversion:
      return print_conversion(i, operation);
    case Shape::double_width:
      return print_double_width(i, operation);
    case Shape::shift:
      return print_shift(i, operation);
    case Shape::bit_field:
      return print_bit_field(i, operation);
    case Shape::atomic:
      return print_atomic(i, operation);
    case Shape::ray_query_getter:
      return print_ray_query_getter(i, operation);
    case Shape::statement:
      return statement("k::", operation.text, "(", lanes_argument(), values_with_sign(i, 0, operation.sign), ");");
  }
}

void Printer::print_infix(const Instruction& i, const Operation& operation) {
  const BaseType base = get<Type>(i.result_type()).basetype;
  const std::string a = value_as(i.operand(0), base), b = value_as(i.operand(1), base);
  define_as(i, fmt::format("{} {} {}", a, operation.text, b), base);
}

void Printer::print_prefix(const Instruction& i, const Operation& operation) {
  const BaseType base = get<Type>(i.result_type()).basetype;
  define_as(i, operation.text + value_as(i.operand(0), base), base);
}

void Printer::print_function(const Instruction& i, const Operation& operation) {
  // Only a ray query's is asked who takes part.
  const std::string lanes = i.op() == spv::OpRayQueryProceedKHR ? lanes_argument() : "";
  const std::string text = fmt::format("k::{}({}{})", operation.text, lanes, values_with_sign(i, 0, operation.sign));
  if (operation.sign == Sign::any) return define(i, text);
  define_as(i, text, with_sign(get<Type>(i.result_type()).basetype, operation.sign));
}

void Printer::print_relation(const Instruction& i, const Operation& operation) {
  const BaseType base = with_sign(type_of(i.operand(0)).basetype, operation.sign);
  const std::string a = value_as(i.operand(0), base), b = value_as(i.operand(1), base);
  if (get<Type>(i.result_type()).vecsize > 1)
    define(i, fmt::format("k::{}({}, {})", operation.function, a, b));
  else
    define(i, fmt::format("{} {} {}", a, operation.text, b));
}

void Printer::print_conversion(const Instruction& i, const Operation& operation) {
  const Type& type = get<Type>(i.result_type());
  const BaseType base = with_sign(type.basetype, operation.sign);
  const std::string operand = value_with_sign(i.operand(0), operation.sign);
  // The decoration is only on conversions to halves.
  const bool truncates = type.basetype == SPIRType::Half && has_decoration(i.result(), spv::DecorationFPRoundingMode) &&
                         get_decoration(i.result(), spv::DecorationFPRoundingMode) == spv::FPRoundingModeRTZ;
  define_as(i,
            fmt::format("k::{}<{}>({})", truncates ? "convert_toward_zero" : operation.text,
                        numbers_name(base, type.vecsize), operand),
            base);
}

void Printer::print_double_width(const Instruction& i, const Operation& operation) {
  // Both halves have the type of the operands, whatever the signs that the operation goes by.
  const Type& type = type_of(i.operand(0));
  const std::string name = numbers_name(type.basetype, type.vecsize);
  define(i, fmt::format("{}{{{}({} {} {}), {}(k::{}({}))}}", type_name(i.result_type()), name, value(i.operand(0)),
                        operation.text, value(i.operand(1)), name, operation.function,
                        values_with_sign(i, 0, operation.sign)));
}

void Printer::print_shift(const Instruction& i, const Operation& operation) {
  const BaseType base = with_sign(get<Type>(i.result_type()).basetype, operation.sign);
  const std::string bits = value_as(i.operand(0), base);
  define_as(i, fmt::format("k::{}({}, {})", operation.text, bits, value(i.operand(1))), base);
}

void Printer::print_bit_field(const Instruction& i, const Operation& operation) {
  check_bit_width(i);
  const BaseType base = with_sign(get<Type>(i.result_type()).basetype, operation.sign);
  // The last two are an offset and a count, where there are more than one.
  const std::size_t bits = i.operand_count() == 1 ? 1 : i.operand_count() - 2;
  std::string arguments;
  for (std::size_t k = 0; k < i.operand_count(); ++k) {
    arguments += k == 0 ? "" : ", ";
    arguments += k < bits ? value_as(i.operand(k), base) : fmt::format("int({})", value(i.operand(k)));
  }
  define_as(i, fmt::format("k::{}({})", operation.text, arguments), base);
}

void Printer::check_bit_width(const Instruction& i) {
  if (type_of(i.operand(0)).width != 32) fail("a bit field instruction on other than 32 bits");
}

void Printer::print_integer_dot(const Instruction& i) {
  const auto is_one_of = [&](spv::Op dot, spv::Op accumulating) { return i.op() == dot || i.op() == accumulating; };
  const bool is_unsigned = is_one_of(spv::OpUDot, spv::OpUDotAccSat);
  const bool is_mixed = is_one_of(spv::OpSUDot, spv::OpSUDotAccSat);
  const bool accumulates = i.op() == spv::OpSDotAccSat || i.op() == spv::OpUDotAccSat || i.op() == spv::OpSUDotAccSat;
  const auto vector = [&](std::uint32_t id, Sign sign) {
    if (type_of(id).vecsize > 1) return value_with_sign(id, sign);
    return fmt::format("k::unpack_4x8<std::{}int8_t>({})", sign == Sign::as_unsigned ? "u" : "", value(id));
  };
  const Sign result_sign = is_unsigned ? Sign::as_unsigned : Sign::as_signed;
  const BaseType base = with_sign(get<Type>(i.result_type()).basetype, result_sign);
  std::string text = fmt::format("k::integer_dot<{}>({}, {})", scalar_name(base), vector(i.operand(0), result_sign),
                                 vector(i.operand(1), is_mixed ? Sign::as_unsigned : result_sign));
  if (accumulates)
    text = fmt::format("k::add_saturated<{}>({}, {})", scalar_name(base), text, value_as(i.operand(2), base));
  define_as(i, text, base);
}

void Printer::print_bit_count(const Instruction& i) {
  check_bit_width(i);
  define_as(i, fmt::format("k::bit_count({})", value(i.operand(0))), SPIRType::Int);
}

void Printer::print_bitcast(const Instruction& i) {
  const Type& type = get<Type>(i.result_type());
  const std::string operand = value(i.operand(0));
  if (is_pointer(type) || is_pointer(type_of(i.operand(0))))
    return define(i, fmt::format("k::bit_cast<{}>({})", type_name(type), operand));
  define_as(i, fmt::format("k::bit_cast<{}>({})", numbers_name(type.basetype, type.vecsize), operand), type.basetype);
}

void Printer::print_ray_query_getter(const Instruction& i, const Operation& operation) {
  std::string arguments = value(i.operand(0));
  // The operand is a constant: 0 the candidate, 1 the committed intersection.
  if (i.operand_count() > 1) arguments += get<SPIRConstant>(i.operand(1)).scalar() != 0 ? ", true" : ", false";
  define(i, fmt::format("{}(k::rayQueryGet{}EXT({}))", type_name(i.result_type()), operation.text, arguments));
}

}  // namespace tandem::cpu
