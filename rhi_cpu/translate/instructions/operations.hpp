#pragma once

#include <cstdint>

#include <spirv_cross/spirv.hpp>

#include "rhi_cpu/translate/instructions/scalar_types.hpp"

namespace tandem::cpu {

/// What the C++ of an operation looks like. a, b, c are its operands, in parentheses how they are converted first: to
/// the signedness of Operation::sign, where they are integers.
enum class Shape : std::uint8_t {
  infix,             ///< a + b (to components of the result)
  prefix,            ///< -a (to components of the result)
  call,              ///< k::function(a, b, c) (each with the sign)
  relation,          ///< a < b of scalars, k::function(a, b) of vectors (both to components of a, with the sign)
  conversion,        ///< k::text<Result>(a) (with the sign, the result too)
  double_width,      ///< {a + b, k::function(a, b)}: the lower and the upper half
  shift,             ///< k::text(a, b) (a to components of the result, with the sign)
  bit_field,         ///< k::text(a, offset, count) or k::text(a, b, offset, count) (a and b as for a shift)
  atomic,            ///< k::atomic_text<Component>(address, a), where a may be a 1 that is no operand (with the sign)
  ray_query_getter,  ///< Result(k::rayQueryGet...EXT(query)), with false or true for the candidate or what is committed
  statement          ///< k::text(a, b, c); without a result (each with the sign)
};

struct Operation {
  spv::Op op;
  Shape shape;
  const char* text;  ///< the operator, or the function's name in rhi_cpu/kernel/
  Sign sign = Sign::any;
  const char* function = "";  ///< of a relation and of a double width, beside the operator
};

/// Every instruction that computes, but for those of Printer::by_hand.
inline constexpr Operation operations[] = {
    // arithmetic
    {spv::OpIAdd, Shape::infix, "+"},
    {spv::OpFAdd, Shape::infix, "+"},
    {spv::OpISub, Shape::infix, "-"},
    {spv::OpFSub, Shape::infix, "-"},
    // 16-bit factors become int and can overflow before they are cut back, which -fwrapv defines.
    {spv::OpIMul, Shape::infix, "*"},
    {spv::OpFMul, Shape::infix, "*"},
    {spv::OpFDiv, Shape::infix, "/"},
    {spv::OpVectorTimesScalar, Shape::infix, "*"},
    {spv::OpMatrixTimesScalar, Shape::infix, "*"},
    {spv::OpFNegate, Shape::call, "negate"},
    {spv::OpSNegate, Shape::call, "negate", Sign::as_signed},
    {spv::OpSDiv, Shape::call, "divide", Sign::as_signed},
    {spv::OpUDiv, Shape::call, "divide", Sign::as_unsigned},
    {spv::OpSRem, Shape::call, "remainder", Sign::as_signed},
    {spv::OpSMod, Shape::call, "modulo", Sign::as_signed},
    {spv::OpUMod, Shape::call, "remainder", Sign::as_unsigned},
    {spv::OpFRem, Shape::call, "float_remainder"},
    {spv::OpFMod, Shape::call, "float_modulo"},
    {spv::OpVectorTimesMatrix, Shape::call, "multiply"},
    {spv::OpMatrixTimesVector, Shape::call, "multiply"},
    {spv::OpMatrixTimesMatrix, Shape::call, "multiply"},
    {spv::OpOuterProduct, Shape::call, "outer_product"},
    {spv::OpDot, Shape::call, "dot"},
    {spv::OpTranspose, Shape::call, "transpose"},
    {spv::OpIAddCarry, Shape::double_width, "+", Sign::any, "add_carry"},
    {spv::OpISubBorrow, Shape::double_width, "-", Sign::any, "subtract_borrow"},
    {spv::OpUMulExtended, Shape::double_width, "*", Sign::as_unsigned, "multiply_high"},
    {spv::OpSMulExtended, Shape::double_width, "*", Sign::as_signed, "multiply_high"},

    // logic and relations
    {spv::OpLogicalAnd, Shape::relation, "&&", Sign::any, "logical_and"},
    {spv::OpLogicalOr, Shape::relation, "||", Sign::any, "logical_or"},
    {spv::OpLogicalEqual, Shape::relation, "==", Sign::any, "equal"},
    {spv::OpLogicalNotEqual, Shape::relation, "!=", Sign::any, "not_equal"},
    {spv::OpIEqual, Shape::relation, "==", Sign::any, "equal"},
    {spv::OpINotEqual, Shape::relation, "!=", Sign::any, "not_equal"},
    {spv::OpSLessThan, Shape::relation, "<", Sign::as_signed, "less"},
    {spv::OpULessThan, Shape::relation, "<", Sign::as_unsigned, "less"},
    {spv::OpSLessThanEqual, Shape::relation, "<=", Sign::as_signed, "less_equal"},
    {spv::OpULessThanEqual, Shape::relation, "<=", Sign::as_unsigned, "less_equal"},
    {spv::OpSGreaterThan, Shape::relation, ">", Sign::as_signed, "greater"},
    {spv::OpUGreaterThan, Shape::relation, ">", Sign::as_unsigned, "greater"},
    {spv::OpSGreaterThanEqual, Shape::relation, ">=", Sign::as_signed, "greater_equal"},
    {spv::OpUGreaterThanEqual, Shape::relation, ">=", Sign::as_unsigned, "greater_equal"},
    {spv::OpFOrdEqual, Shape::relation, "==", Sign::any, "equal"},
    {spv::OpFUnordNotEqual, Shape::relation, "!=", Sign::any, "not_equal"},
    {spv::OpFOrdLessThan, Shape::relation, "<", Sign::any, "less"},
    {spv::OpFOrdLessThanEqual, Shape::relation, "<=", Sign::any, "less_equal"},
    {spv::OpFOrdGreaterThan, Shape::relation, ">", Sign::any, "greater"},
    {spv::OpFOrdGreaterThanEqual, Shape::relation, ">=", Sign::any, "greater_equal"},
    // Those of which a NaN makes C++'s operators say the opposite.
    {spv::OpFOrdNotEqual, Shape::call, "ordered_not_equal"},
    {spv::OpFUnordEqual, Shape::call, "unordered_equal"},
    {spv::OpFUnordLessThan, Shape::call, "unordered_less"},
    {spv::OpFUnordLessThanEqual, Shape::call, "unordered_less_equal"},
    {spv::OpFUnordGreaterThan, Shape::call, "unordered_greater"},
    {spv::OpFUnordGreaterThanEqual, Shape::call, "unordered_greater_equal"},
    {spv::OpLogicalNot, Shape::call, "logical_not"},
    {spv::OpAny, Shape::call, "any"},
    {spv::OpAll, Shape::call, "all"},
    {spv::OpIsNan, Shape::call, "is_nan"},
    {spv::OpIsInf, Shape::call, "is_inf"},
    {spv::OpSelect, Shape::call, "select"},

    // conversions
    {spv::OpConvertFToS, Shape::conversion, "float_to_signed", Sign::as_signed},
    {spv::OpConvertFToU, Shape::conversion, "float_to_unsigned", Sign::as_unsigned},
    {spv::OpConvertSToF, Shape::conversion, "convert", Sign::as_signed},
    {spv::OpConvertUToF, Shape::conversion, "convert", Sign::as_unsigned},
    {spv::OpFConvert, Shape::conversion, "convert"},
    {spv::OpQuantizeToF16, Shape::call, "quantize_to_half"},
    {spv::OpSConvert, Shape::conversion, "convert", Sign::as_signed},
    {spv::OpUConvert, Shape::conversion, "convert", Sign::as_unsigned},

    // bits
    {spv::OpBitwiseOr, Shape::infix, "|"},
    {spv::OpBitwiseXor, Shape::infix, "^"},
    {spv::OpBitwiseAnd, Shape::infix, "&"},
    {spv::OpNot, Shape::prefix, "~"},
    {spv::OpShiftLeftLogical, Shape::shift, "shift_left"},
    {spv::OpShiftRightLogical, Shape::shift, "shift_right", Sign::as_unsigned},
    {spv::OpShiftRightArithmetic, Shape::shift, "shift_right", Sign::as_signed},
    {spv::OpBitFieldInsert, Shape::bit_field, "bitfield_insert"},
    {spv::OpBitFieldSExtract, Shape::bit_field, "bitfield_extract", Sign::as_signed},
    {spv::OpBitFieldUExtract, Shape::bit_field, "bitfield_extract", Sign::as_unsigned},
    {spv::OpBitReverse, Shape::bit_field, "bitfield_reverse"},

    // atomics
    {spv::OpAtomicExchange, Shape::atomic, "exchange"},
    {spv::OpAtomicIIncrement, Shape::atomic, "add"},
    {spv::OpAtomicIDecrement, Shape::atomic, "subtract"},
    {spv::OpAtomicIAdd, Shape::atomic, "add"},
    {spv::OpAtomicFAddEXT, Shape::atomic, "add"},
    {spv::OpAtomicFMinEXT, Shape::atomic, "min"},
    {spv::OpAtomicFMaxEXT, Shape::atomic, "max"},
    {spv::OpAtomicISub, Shape::atomic, "subtract"},
    {spv::OpAtomicSMin, Shape::atomic, "min", Sign::as_signed},
    {spv::OpAtomicUMin, Shape::atomic, "min", Sign::as_unsigned},
    {spv::OpAtomicSMax, Shape::atomic, "max", Sign::as_signed},
    {spv::OpAtomicUMax, Shape::atomic, "max", Sign::as_unsigned},
    {spv::OpAtomicAnd, Shape::atomic, "and"},
    {spv::OpAtomicOr, Shape::atomic, "or"},
    {spv::OpAtomicXor, Shape::atomic, "xor"},

    // rays
    {spv::OpRayQueryInitializeKHR, Shape::statement, "rayQueryInitializeEXT", Sign::as_unsigned},
    {spv::OpRayQueryTerminateKHR, Shape::statement, "rayQueryTerminateEXT"},
    {spv::OpRayQueryConfirmIntersectionKHR, Shape::statement, "rayQueryConfirmIntersectionEXT"},
    {spv::OpRayQueryGenerateIntersectionKHR, Shape::statement, "rayQueryGenerateIntersectionEXT"},
    {spv::OpRayQueryProceedKHR, Shape::call, "rayQueryProceedEXT"},
    {spv::OpRayQueryGetRayTMinKHR, Shape::ray_query_getter, "RayTMin"},
    {spv::OpRayQueryGetRayFlagsKHR, Shape::ray_query_getter, "RayFlags"},
    {spv::OpRayQueryGetWorldRayDirectionKHR, Shape::ray_query_getter, "WorldRayDirection"},
    {spv::OpRayQueryGetWorldRayOriginKHR, Shape::ray_query_getter, "WorldRayOrigin"},
    {spv::OpRayQueryGetIntersectionCandidateAABBOpaqueKHR, Shape::ray_query_getter, "IntersectionCandidateAABBOpaque"},
    {spv::OpRayQueryGetIntersectionTypeKHR, Shape::ray_query_getter, "IntersectionType"},
    {spv::OpRayQueryGetIntersectionTKHR, Shape::ray_query_getter, "IntersectionT"},
    {spv::OpRayQueryGetIntersectionInstanceCustomIndexKHR, Shape::ray_query_getter, "IntersectionInstanceCustomIndex"},
    {spv::OpRayQueryGetIntersectionInstanceIdKHR, Shape::ray_query_getter, "IntersectionInstanceId"},
    {spv::OpRayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetKHR, Shape::ray_query_getter,
     "IntersectionInstanceShaderBindingTableRecordOffset"},
    {spv::OpRayQueryGetIntersectionGeometryIndexKHR, Shape::ray_query_getter, "IntersectionGeometryIndex"},
    {spv::OpRayQueryGetIntersectionPrimitiveIndexKHR, Shape::ray_query_getter, "IntersectionPrimitiveIndex"},
    {spv::OpRayQueryGetIntersectionBarycentricsKHR, Shape::ray_query_getter, "IntersectionBarycentrics"},
    {spv::OpRayQueryGetIntersectionFrontFaceKHR, Shape::ray_query_getter, "IntersectionFrontFace"},
    {spv::OpRayQueryGetIntersectionObjectRayDirectionKHR, Shape::ray_query_getter, "IntersectionObjectRayDirection"},
    {spv::OpRayQueryGetIntersectionObjectRayOriginKHR, Shape::ray_query_getter, "IntersectionObjectRayOrigin"},
    {spv::OpRayQueryGetIntersectionObjectToWorldKHR, Shape::ray_query_getter, "IntersectionObjectToWorld"},
    {spv::OpRayQueryGetIntersectionWorldToObjectKHR, Shape::ray_query_getter, "IntersectionWorldToObject"},
};

/// The operation of an instruction; null when it is none of the table.
constexpr const Operation* find_operation(spv::Op op) {
  for (const Operation& each : operations)
    if (each.op == op) return &each;
  return nullptr;
}

}  // namespace tandem::cpu
