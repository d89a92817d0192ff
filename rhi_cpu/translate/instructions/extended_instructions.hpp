#pragma once

#include <cstdint>

#include <spirv_cross/GLSL.std.450.h>

#include "rhi_cpu/translate/instructions/scalar_types.hpp"

namespace tandem::cpu {

/// What the C++ of an instruction of GLSL.std.450 looks like.
enum class ExtendedShape : std::uint8_t {
  function,            ///< k::function(a, b, c), operands as ExtendedInstruction::sign says
  bit_search,          ///< as function, of 32 bits; the result is an int
  split_into_pointer,  ///< k::function(a, *b): two results, one of them behind a pointer
  split_into_struct    ///< two results, the members of a struct
};

struct ExtendedInstruction {
  GLSLstd450 instruction;
  const char* function;  ///< its name in rhi_cpu/kernel/
  Sign sign = Sign::any;
  ExtendedShape shape = ExtendedShape::function;
};

/// Every instruction of GLSL.std.450 that the CPU device has.
inline constexpr ExtendedInstruction extended_instructions[] = {
    {GLSLstd450Round, "round_even"},
    {GLSLstd450RoundEven, "round_even"},
    {GLSLstd450Trunc, "trunc"},
    {GLSLstd450FAbs, "abs"},
    {GLSLstd450SAbs, "abs", Sign::as_signed},
    {GLSLstd450FSign, "sign"},
    {GLSLstd450SSign, "sign", Sign::as_signed},
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
    {GLSLstd450UMin, "min", Sign::as_unsigned},
    {GLSLstd450SMin, "min", Sign::as_signed},
    {GLSLstd450FMax, "max"},
    {GLSLstd450UMax, "max", Sign::as_unsigned},
    {GLSLstd450SMax, "max", Sign::as_signed},
    {GLSLstd450FClamp, "clamp"},
    {GLSLstd450UClamp, "clamp", Sign::as_unsigned},
    {GLSLstd450SClamp, "clamp", Sign::as_signed},
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
    {GLSLstd450FindILsb, "find_lsb", Sign::as_unsigned, ExtendedShape::bit_search},
    {GLSLstd450FindSMsb, "find_msb", Sign::as_signed, ExtendedShape::bit_search},
    {GLSLstd450FindUMsb, "find_msb", Sign::as_unsigned, ExtendedShape::bit_search},
    {GLSLstd450NMin, "min"},
    {GLSLstd450NMax, "max"},
    {GLSLstd450NClamp, "clamp"},
    {GLSLstd450Modf, "modf", Sign::any, ExtendedShape::split_into_pointer},
    {GLSLstd450ModfStruct, "modf", Sign::any, ExtendedShape::split_into_struct},
    {GLSLstd450Frexp, "frexp", Sign::any, ExtendedShape::split_into_pointer},
    {GLSLstd450FrexpStruct, "frexp", Sign::any, ExtendedShape::split_into_struct},
};

/// Null when the table has none.
constexpr const ExtendedInstruction* find_extended(std::uint32_t instruction) {
  for (const ExtendedInstruction& each : extended_instructions)
    if (each.instruction == instruction) return &each;
  return nullptr;
}

}  // namespace tandem::cpu
