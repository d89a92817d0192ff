#include <fmt/format.h>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRType;

bool Printer::is_integer(BaseType base) { return to_signed(base) == base || to_unsigned(base) == base; }

Printer::BaseType Printer::to_signed(BaseType base) {
  switch (base) {
    case SPIRType::SByte:
    case SPIRType::UByte:
      return SPIRType::SByte;
    case SPIRType::Short:
    case SPIRType::UShort:
      return SPIRType::Short;
    case SPIRType::Int:
    case SPIRType::UInt:
      return SPIRType::Int;
    case SPIRType::Int64:
    case SPIRType::UInt64:
      return SPIRType::Int64;
    default:
      return SPIRType::Unknown;
  }
}

Printer::BaseType Printer::to_unsigned(BaseType base) {
  switch (to_signed(base)) {
    case SPIRType::SByte:
      return SPIRType::UByte;
    case SPIRType::Short:
      return SPIRType::UShort;
    case SPIRType::Int:
      return SPIRType::UInt;
    case SPIRType::Int64:
      return SPIRType::UInt64;
    default:
      return SPIRType::Unknown;
  }
}

std::string Printer::value_as(std::uint32_t id, BaseType base) {
  const Type& type = type_of(id);
  if (type.basetype == base) return value(id);
  return fmt::format("{}({})", vector_name(base, type.vecsize), value(id));
}

std::string Printer::value_signed(std::uint32_t id) { return value_as(id, to_signed(type_of(id).basetype)); }
std::string Printer::value_unsigned(std::uint32_t id) { return value_as(id, to_unsigned(type_of(id).basetype)); }

void Printer::define(std::uint32_t type_id, std::uint32_t id, const std::string& text) {
  emit_op(type_id, id, text, false);
}

void Printer::define_as(std::uint32_t type_id, std::uint32_t id, const std::string& text, BaseType base) {
  const Type& type = get<Type>(type_id);
  // Arithmetic on 8 and 16 bits is done in int by C++.
  const bool promoted = type.vecsize == 1 && type.width < 32 && is_integer(base);
  define(type_id, id, type.basetype == base && !promoted ? text : fmt::format("{}({})", type_name(type), text));
}

bool Printer::print_arithmetic(spv::Op op, Operands ops) {
  const BaseType base = get<Type>(ops[0]).basetype;
  const auto infix = [&](const char* sign) {
    define_as(ops[0], ops[1], fmt::format("{} {} {}", value_as(ops[2], base), sign, value_as(ops[3], base)), base);
    return true;
  };
  const auto call = [&](const char* function, BaseType operands) {
    define_as(ops[0], ops[1],
              fmt::format("k::{}({}, {})", function, value_as(ops[2], operands), value_as(ops[3], operands)), operands);
    return true;
  };
  switch (op) {
    case spv::OpIAdd:
    case spv::OpFAdd:
      return infix("+");
    case spv::OpISub:
    case spv::OpFSub:
      return infix("-");
    case spv::OpIMul:
      // 16-bit factors become int and can overflow before they are cut back, which -fwrapv defines.
    case spv::OpFMul:
      return infix("*");
    case spv::OpFDiv:
      return infix("/");
    case spv::OpSDiv:
      return call("divide", to_signed(base));
    case spv::OpUDiv:
      return call("divide", to_unsigned(base));
    case spv::OpSRem:
      return call("remainder", to_signed(base));
    case spv::OpSMod:
      return call("modulo", to_signed(base));
    case spv::OpUMod:
      return call("remainder", to_unsigned(base));
    case spv::OpFRem:
      return call("float_remainder", base);
    case spv::OpFMod:
      return call("float_modulo", base);
    case spv::OpSNegate:
      define_as(ops[0], ops[1], fmt::format("k::negate({})", value_signed(ops[2])), to_signed(base));
      return true;
    case spv::OpFNegate:
      define(ops[0], ops[1], fmt::format("-{}", value(ops[2])));
      return true;
    case spv::OpVectorTimesScalar:
    case spv::OpMatrixTimesScalar:
      define(ops[0], ops[1], fmt::format("{} * {}", value(ops[2]), value(ops[3])));
      return true;
    case spv::OpIAddCarry:
      print_extended_result(ops, fmt::format("{} + {}", value(ops[2]), value(ops[3])),
                            fmt::format("k::add_carry({}, {})", value(ops[2]), value(ops[3])));
      return true;
    case spv::OpISubBorrow:
      print_extended_result(ops, fmt::format("{} - {}", value(ops[2]), value(ops[3])),
                            fmt::format("k::subtract_borrow({}, {})", value(ops[2]), value(ops[3])));
      return true;
    case spv::OpUMulExtended:
    case spv::OpSMulExtended:
      print_extended_result(ops, fmt::format("{} * {}", value(ops[2]), value(ops[3])),
                            fmt::format("k::multiply_high({}, {})", value(ops[2]), value(ops[3])));
      return true;
    default:
      return false;
  }
}

void Printer::print_extended_result(Operands ops, const std::string& low, const std::string& high) {
  if (type_of(ops[2]).width != 32) fail("integer arithmetic with a double-width result on other than 32 bits");
  define(ops[0], ops[1], fmt::format("{}{{{}, {}}}", type_name(ops[0]), low, high));
}

bool Printer::print_relation(spv::Op op, Operands ops) {
  const auto call = [&](const char* function, const std::string& a, const std::string& b) {
    define(ops[0], ops[1], fmt::format("k::{}({}, {})", function, a, b));
    return true;
  };
  // Scalars print the operator, which reads better.
  const auto relation = [&](const char* sign, const char* function, const std::string& a, const std::string& b) {
    if (get<Type>(ops[0]).vecsize > 1) return call(function, a, b);
    define(ops[0], ops[1], fmt::format("{} {} {}", a, sign, b));
    return true;
  };
  const auto same = [&](const char* sign, const char* function) {
    return relation(sign, function, value(ops[2]), value_as(ops[3], type_of(ops[2]).basetype));
  };
  const auto with_sign = [&](const char* sign, const char* function) {
    return relation(sign, function, value_signed(ops[2]), value_signed(ops[3]));
  };
  const auto without_sign = [&](const char* sign, const char* function) {
    return relation(sign, function, value_unsigned(ops[2]), value_unsigned(ops[3]));
  };
  const auto unordered = [&](const char* function) { return call(function, value(ops[2]), value(ops[3])); };
  switch (op) {
    case spv::OpIEqual:
    case spv::OpFOrdEqual:
    case spv::OpLogicalEqual:
      return same("==", "equal");
    case spv::OpINotEqual:
    case spv::OpFUnordNotEqual:
    case spv::OpLogicalNotEqual:
      return same("!=", "not_equal");
    case spv::OpFOrdLessThan:
      return same("<", "less");
    case spv::OpFOrdLessThanEqual:
      return same("<=", "less_equal");
    case spv::OpFOrdGreaterThan:
      return same(">", "greater");
    case spv::OpFOrdGreaterThanEqual:
      return same(">=", "greater_equal");
    case spv::OpSLessThan:
      return with_sign("<", "less");
    case spv::OpSLessThanEqual:
      return with_sign("<=", "less_equal");
    case spv::OpSGreaterThan:
      return with_sign(">", "greater");
    case spv::OpSGreaterThanEqual:
      return with_sign(">=", "greater_equal");
    case spv::OpULessThan:
      return without_sign("<", "less");
    case spv::OpULessThanEqual:
      return without_sign("<=", "less_equal");
    case spv::OpUGreaterThan:
      return without_sign(">", "greater");
    case spv::OpUGreaterThanEqual:
      return without_sign(">=", "greater_equal");
    case spv::OpFOrdNotEqual:
      return unordered("ordered_not_equal");
    case spv::OpFUnordEqual:
      return unordered("unordered_equal");
    case spv::OpFUnordLessThan:
      return unordered("unordered_less");
    case spv::OpFUnordLessThanEqual:
      return unordered("unordered_less_equal");
    case spv::OpFUnordGreaterThan:
      return unordered("unordered_greater");
    case spv::OpFUnordGreaterThanEqual:
      return unordered("unordered_greater_equal");
    case spv::OpLogicalAnd:
      return relation("&&", "logical_and", value(ops[2]), value(ops[3]));
    case spv::OpLogicalOr:
      return relation("||", "logical_or", value(ops[2]), value(ops[3]));
    case spv::OpLogicalNot:
      define(ops[0], ops[1], fmt::format("k::logical_not({})", value(ops[2])));
      return true;
    case spv::OpAny:
      define(ops[0], ops[1], fmt::format("k::any({})", value(ops[2])));
      return true;
    case spv::OpAll:
      define(ops[0], ops[1], fmt::format("k::all({})", value(ops[2])));
      return true;
    case spv::OpIsNan:
      define(ops[0], ops[1], fmt::format("k::is_nan({})", value(ops[2])));
      return true;
    case spv::OpIsInf:
      define(ops[0], ops[1], fmt::format("k::is_inf({})", value(ops[2])));
      return true;
    case spv::OpSelect:
      define(ops[0], ops[1], fmt::format("k::select({}, {}, {})", value(ops[2]), value(ops[3]), value(ops[4])));
      return true;
    default:
      return false;
  }
}

bool Printer::print_conversion(spv::Op op, Operands ops) {
  const Type& to = get<Type>(ops[0]);
  const auto call = [&](const char* function, BaseType target, const std::string& operand) {
    define_as(ops[0], ops[1], fmt::format("k::{}<{}>({})", function, vector_name(target, to.vecsize), operand), target);
    return true;
  };
  switch (op) {
    case spv::OpConvertFToS:
      return call("float_to_signed", to_signed(to.basetype), value(ops[2]));
    case spv::OpConvertFToU:
      return call("float_to_unsigned", to_unsigned(to.basetype), value(ops[2]));
    case spv::OpConvertSToF:
      return call("convert", to.basetype, value_signed(ops[2]));
    case spv::OpConvertUToF:
      return call("convert", to.basetype, value_unsigned(ops[2]));
    case spv::OpFConvert:
      return call("convert", to.basetype, value(ops[2]));
    case spv::OpSConvert:
      return call("convert", to_signed(to.basetype), value_signed(ops[2]));
    case spv::OpUConvert:
      return call("convert", to_unsigned(to.basetype), value_unsigned(ops[2]));
    case spv::OpBitcast:
    case spv::OpConvertUToPtr:
    case spv::OpConvertPtrToU:
      if (is_pointer(to) || is_pointer(type_of(ops[2]))) {
        define(ops[0], ops[1], fmt::format("k::bit_cast<{}>({})", type_name(to), value(ops[2])));
        return true;
      }
      return call("bit_cast", to.basetype, value(ops[2]));
    default:
      return false;
  }
}

bool Printer::print_bits(spv::Op op, Operands ops) {
  const BaseType base = get<Type>(ops[0]).basetype;
  const auto infix = [&](const char* sign) {
    define_as(ops[0], ops[1], fmt::format("{} {} {}", value_as(ops[2], base), sign, value_as(ops[3], base)), base);
    return true;
  };
  const auto call = [&](const char* function, BaseType operand, const std::string& more) {
    define_as(ops[0], ops[1], fmt::format("k::{}({}{})", function, value_as(ops[2], operand), more), operand);
    return true;
  };
  const auto only_32_bits = [&] {
    if (type_of(ops[2]).width != 32) fail("a bit field instruction on other than 32 bits");
  };
  switch (op) {
    case spv::OpBitwiseOr:
      return infix("|");
    case spv::OpBitwiseXor:
      return infix("^");
    case spv::OpBitwiseAnd:
      return infix("&");
    case spv::OpNot:
      define_as(ops[0], ops[1], fmt::format("~{}", value_as(ops[2], base)), base);
      return true;
    case spv::OpShiftLeftLogical:
      return call("shift_left", base, ", " + value(ops[3]));
    case spv::OpShiftRightLogical:
      return call("shift_right", to_unsigned(base), ", " + value(ops[3]));
    case spv::OpShiftRightArithmetic:
      return call("shift_right", to_signed(base), ", " + value(ops[3]));
    case spv::OpBitFieldInsert:
      only_32_bits();
      return call("bitfield_insert", base,
                  fmt::format(", {}, int({}), int({})", value_as(ops[3], base), value(ops[4]), value(ops[5])));
    case spv::OpBitFieldSExtract:
      only_32_bits();
      return call("bitfield_extract", to_signed(base), fmt::format(", int({}), int({})", value(ops[3]), value(ops[4])));
    case spv::OpBitFieldUExtract:
      only_32_bits();
      return call("bitfield_extract", to_unsigned(base),
                  fmt::format(", int({}), int({})", value(ops[3]), value(ops[4])));
    case spv::OpBitReverse:
      only_32_bits();
      return call("bitfield_reverse", base, "");
    case spv::OpBitCount:
      only_32_bits();
      define_as(ops[0], ops[1], fmt::format("k::bit_count({})", value(ops[2])), SPIRType::Int);
      return true;
    default:
      return false;
  }
}

bool Printer::print_matrix(spv::Op op, Operands ops) {
  const auto call = [&](const char* function) {
    define(ops[0], ops[1], fmt::format("k::{}({}, {})", function, value(ops[2]), value(ops[3])));
    return true;
  };
  switch (op) {
    case spv::OpVectorTimesMatrix:
    case spv::OpMatrixTimesVector:
    case spv::OpMatrixTimesMatrix:
      return call("multiply");
    case spv::OpOuterProduct:
      return call("outer_product");
    case spv::OpDot:
      return call("dot");
    case spv::OpTranspose:
      define(ops[0], ops[1], fmt::format("k::transpose({})", value(ops[2])));
      return true;
    default:
      return false;
  }
}

}  // namespace tandem::cpu
