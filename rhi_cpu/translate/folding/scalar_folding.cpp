#include "rhi_cpu/translate/folding/scalar_folding.hpp"

#include <bit>
#include <cmath>

#include "rhi_cpu/kernel/half_conversion.hpp"

namespace tandem::cpu {
namespace {

std::uint64_t low_bits(std::uint64_t bits, std::uint32_t width) {
  return width >= 64 ? bits : bits & ((std::uint64_t{1} << width) - 1);
}

std::int64_t as_signed(const ScalarConstant& a) {
  const std::uint32_t unused = 64 - a.width;
  return static_cast<std::int64_t>(a.bits << unused) >> unused;
}

std::uint64_t as_bits(std::int64_t a) { return static_cast<std::uint64_t>(a); }

double float_value(const ScalarConstant& a) {
  if (a.width == 64) return std::bit_cast<double>(a.bits);
  if (a.width == 32) return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(a.bits)));
  return static_cast<double>(kernel::half_to_float(static_cast<std::uint32_t>(a.bits)));
}

std::uint64_t float_bits(double value, std::uint32_t width) {
  if (width == 64) return std::bit_cast<std::uint64_t>(value);
  if (width == 32) return std::bit_cast<std::uint32_t>(static_cast<float>(value));
  return kernel::double_to_half(value);
}

std::uint64_t quantized(const ScalarConstant& a) {
  const double smallest_normal = std::ldexp(1.0, -14), value = float_value(a);
  if (std::fabs(value) < smallest_normal) return float_bits(std::copysign(0.0, value), a.width);
  return float_bits(static_cast<double>(kernel::half_to_float(kernel::double_to_half(value))), a.width);
}

// As kernel::divide, kernel::remainder and kernel::modulo.

std::int64_t divided(std::int64_t a, std::int64_t b) {
  if (b == 0) return 0;
  return b == -1 ? static_cast<std::int64_t>(0 - as_bits(a)) : a / b;
}

std::int64_t remainder_of(std::int64_t a, std::int64_t b) {
  if (b == 0) return -1;
  return b == -1 ? 0 : a % b;
}

std::int64_t modulo_of(std::int64_t a, std::int64_t b) {
  const std::int64_t r = remainder_of(a, b);
  return b != 0 && r != 0 && (r < 0) != (b < 0) ? r + b : r;
}

std::optional<std::uint64_t> unary(spv::Op op, const ScalarConstant& a, std::uint32_t width) {
  switch (op) {
    case spv::OpSConvert:
      return as_bits(as_signed(a));
    case spv::OpUConvert:
      return a.bits;
    case spv::OpFConvert:
      return float_bits(float_value(a), width);
    case spv::OpQuantizeToF16:
      return quantized(a);
    case spv::OpSNegate:
      return 0 - a.bits;
    case spv::OpNot:
      return ~a.bits;
    case spv::OpLogicalNot:
      return a.bits ^ 1;
    default:
      return std::nullopt;
  }
}

std::optional<std::uint64_t> arithmetic(spv::Op op, const ScalarConstant& a, const ScalarConstant& b) {
  const std::uint64_t all_ones = ~std::uint64_t{0};
  const std::uint64_t count = b.bits & (a.width - 1);
  switch (op) {
    case spv::OpIAdd:
      return a.bits + b.bits;
    case spv::OpISub:
      return a.bits - b.bits;
    case spv::OpIMul:
      return a.bits * b.bits;
    case spv::OpUDiv:
      return b.bits == 0 ? all_ones : a.bits / b.bits;
    case spv::OpUMod:
      return b.bits == 0 ? all_ones : a.bits % b.bits;
    case spv::OpSDiv:
      return as_bits(divided(as_signed(a), as_signed(b)));
    case spv::OpSRem:
      return as_bits(remainder_of(as_signed(a), as_signed(b)));
    case spv::OpSMod:
      return as_bits(modulo_of(as_signed(a), as_signed(b)));
    case spv::OpShiftLeftLogical:
      return a.bits << count;
    case spv::OpShiftRightLogical:
      return a.bits >> count;
    case spv::OpShiftRightArithmetic:
      return as_bits(as_signed(a) >> count);
    case spv::OpBitwiseAnd:
    case spv::OpLogicalAnd:
      return a.bits & b.bits;
    case spv::OpBitwiseOr:
    case spv::OpLogicalOr:
      return a.bits | b.bits;
    case spv::OpBitwiseXor:
      return a.bits ^ b.bits;
    default:
      return std::nullopt;
  }
}

std::optional<bool> relation(spv::Op op, const ScalarConstant& a, const ScalarConstant& b) {
  switch (op) {
    case spv::OpIEqual:
    case spv::OpLogicalEqual:
      return a.bits == b.bits;
    case spv::OpINotEqual:
    case spv::OpLogicalNotEqual:
      return a.bits != b.bits;
    case spv::OpULessThan:
      return a.bits < b.bits;
    case spv::OpULessThanEqual:
      return a.bits <= b.bits;
    case spv::OpUGreaterThan:
      return a.bits > b.bits;
    case spv::OpUGreaterThanEqual:
      return a.bits >= b.bits;
    case spv::OpSLessThan:
      return as_signed(a) < as_signed(b);
    case spv::OpSLessThanEqual:
      return as_signed(a) <= as_signed(b);
    case spv::OpSGreaterThan:
      return as_signed(a) > as_signed(b);
    case spv::OpSGreaterThanEqual:
      return as_signed(a) >= as_signed(b);
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<ScalarConstant> fold_scalar(spv::Op op, std::span<const ScalarConstant> operands, std::uint32_t width) {
  std::optional<std::uint64_t> bits;
  if (operands.size() == 1) bits = unary(op, operands[0], width);
  if (operands.size() == 2) {
    bits = arithmetic(op, operands[0], operands[1]);
    if (const std::optional<bool> holds = relation(op, operands[0], operands[1])) bits = *holds ? 1 : 0;
  }
  if (operands.size() == 3 && op == spv::OpSelect) bits = operands[operands[0].bits != 0 ? 1 : 2].bits;
  if (!bits) return std::nullopt;
  return ScalarConstant{low_bits(*bits, width), width};
}

}  // namespace tandem::cpu
