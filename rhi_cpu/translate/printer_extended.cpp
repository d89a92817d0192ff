#include <fmt/format.h>
#include <spirv_cross/GLSL.std.450.h>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRExtension;
using spirv_cross::SPIRType;

namespace {

/// How an extended instruction is called: all its operands go to the kernel function of the same meaning.
struct Function {
  GLSLstd450 instruction;
  const char* name;
  enum class Operands { any, as_signed, as_unsigned } operands = Operands::any;
};

constexpr Function functions[] = {{GLSLstd450Round, "round_even"},
                                  {GLSLstd450RoundEven, "round_even"},
                                  {GLSLstd450Trunc, "trunc"},
                                  {GLSLstd450FAbs, "abs"},
                                  {GLSLstd450SAbs, "abs", Function::Operands::as_signed},
                                  {GLSLstd450FSign, "sign"},
                                  {GLSLstd450SSign, "sign", Function::Operands::as_signed},
                                  {GLSLstd450Floor, "floor"},
                                  {GLSLstd450Ceil, "ceil"},
                                  {GLSLstd450Fract, "fract"},
                                  {GLSLstd450Radians, "radians"},
                                  {GLSLstd450Degrees, "degrees"},
                                  {GLSLstd450Sin, "sin"},
                                  {GLSLstd450Cos, "cos"},
                                  {GLSLstd450Tan, "tan"},
                                  {GLSLstd450Asin, "asin"},
                                  {GLSLstd450Acos, "acos"},
                                  {GLSLstd450Atan, "atan"},
                                  {GLSLstd450Sinh, "sinh"},
                                  {GLSLstd450Cosh, "cosh"},
                                  {GLSLstd450Tanh, "tanh"},
                                  {GLSLstd450Asinh, "asinh"},
                                  {GLSLstd450Acosh, "acosh"},
                                  {GLSLstd450Atanh, "atanh"},
                                  {GLSLstd450Atan2, "atan2"},
                                  {GLSLstd450Pow, "pow"},
                                  {GLSLstd450Exp, "exp"},
                                  {GLSLstd450Log, "log"},
                                  {GLSLstd450Exp2, "exp2"},
                                  {GLSLstd450Log2, "log2"},
                                  {GLSLstd450Sqrt, "sqrt"},
                                  {GLSLstd450InverseSqrt, "inverse_sqrt"},
                                  {GLSLstd450Determinant, "determinant"},
                                  {GLSLstd450MatrixInverse, "inverse"},
                                  {GLSLstd450FMin, "min"},
                                  {GLSLstd450UMin, "min", Function::Operands::as_unsigned},
                                  {GLSLstd450SMin, "min", Function::Operands::as_signed},
                                  {GLSLstd450FMax, "max"},
                                  {GLSLstd450UMax, "max", Function::Operands::as_unsigned},
                                  {GLSLstd450SMax, "max", Function::Operands::as_signed},
                                  {GLSLstd450FClamp, "clamp"},
                                  {GLSLstd450UClamp, "clamp", Function::Operands::as_unsigned},
                                  {GLSLstd450SClamp, "clamp", Function::Operands::as_signed},
                                  {GLSLstd450FMix, "mix"},
                                  {GLSLstd450Step, "step"},
                                  {GLSLstd450SmoothStep, "smooth_step"},
                                  {GLSLstd450Fma, "fma"},
                                  {GLSLstd450Ldexp, "ldexp"},
                                  {GLSLstd450PackSnorm4x8, "pack_snorm_4x8"},
                                  {GLSLstd450PackUnorm4x8, "pack_unorm_4x8"},
                                  {GLSLstd450PackSnorm2x16, "pack_snorm_2x16"},
                                  {GLSLstd450PackUnorm2x16, "pack_unorm_2x16"},
                                  {GLSLstd450PackHalf2x16, "pack_half_2x16"},
                                  {GLSLstd450PackDouble2x32, "pack_double_2x32"},
                                  {GLSLstd450UnpackSnorm2x16, "unpack_snorm_2x16"},
                                  {GLSLstd450UnpackUnorm2x16, "unpack_unorm_2x16"},
                                  {GLSLstd450UnpackHalf2x16, "unpack_half_2x16"},
                                  {GLSLstd450UnpackSnorm4x8, "unpack_snorm_4x8"},
                                  {GLSLstd450UnpackUnorm4x8, "unpack_unorm_4x8"},
                                  {GLSLstd450UnpackDouble2x32, "unpack_double_2x32"},
                                  {GLSLstd450Length, "length"},
                                  {GLSLstd450Distance, "distance"},
                                  {GLSLstd450Cross, "cross"},
                                  {GLSLstd450Normalize, "normalize"},
                                  {GLSLstd450FaceForward, "face_forward"},
                                  {GLSLstd450Reflect, "reflect"},
                                  {GLSLstd450Refract, "refract"},
                                  {GLSLstd450FindILsb, "find_lsb", Function::Operands::as_unsigned},
                                  {GLSLstd450FindSMsb, "find_msb", Function::Operands::as_signed},
                                  {GLSLstd450FindUMsb, "find_msb", Function::Operands::as_unsigned},
                                  {GLSLstd450NMin, "min"},
                                  {GLSLstd450NMax, "max"},
                                  {GLSLstd450NClamp, "clamp"}};

}  // namespace

void Printer::print_extended(Operands ops, std::uint32_t length) {
  if (get<SPIRExtension>(ops[2]).ext != SPIRExtension::GLSL) return;  // NonSemantic
  const auto instruction = static_cast<GLSLstd450>(ops[3]);
  switch (instruction) {
    case GLSLstd450Modf:
      return print_split(ops, "modf", true);
    case GLSLstd450ModfStruct:
      return print_split(ops, "modf", false);
    case GLSLstd450Frexp:
      return print_split(ops, "frexp", true);
    case GLSLstd450FrexpStruct:
      return print_split(ops, "frexp", false);
    default:
      break;
  }
  for (const Function& function : functions) {
    if (function.instruction != instruction) continue;
    const bool bits = instruction >= GLSLstd450FindILsb && instruction <= GLSLstd450FindUMsb;
    if (bits && type_of(ops[4]).width != 32) fail("a bit search on other than 32 bits");
    std::string arguments;
    BaseType base = get<Type>(ops[0]).basetype;
    for (std::uint32_t i = 4; i < length; ++i) {
      arguments += i == 4 ? "" : ", ";
      BaseType operand = type_of(ops[i]).basetype;
      if (function.operands == Function::Operands::as_signed) operand = to_signed(operand);
      if (function.operands == Function::Operands::as_unsigned) operand = to_unsigned(operand);
      if (function.operands != Function::Operands::any) base = bits ? SPIRType::Int : operand;
      arguments += value_as(ops[i], operand);
    }
    return define_as(ops[0], ops[1], fmt::format("k::{}({})", function.name, arguments), base);
  }
  fail(fmt::format("GLSL.std.450 instruction {}", ops[3]));
}

void Printer::print_split(Operands ops, const char* function, bool through_pointer) {
  if (!through_pointer) {
    // The result is a struct of both parts.
    const std::vector<std::string> members = member_names(get<Type>(ops[0]));
    define(ops[0], ops[1], type_name(ops[0]) + "{}");
    const std::string result = value(ops[1]);
    statement(fmt::format("{0}.{1} = k::{3}({4}, {0}.{2});", result, members[0], members[1], function, value(ops[4])));
    return;
  }
  if (is_buffer_pointer(ops[5])) fail(fmt::format("{} into a buffer", function));
  define(ops[0], ops[1], fmt::format("k::{}({}, {})", function, value(ops[4]), value(ops[5])));
}

}  // namespace tandem::cpu
