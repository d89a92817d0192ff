#include <bit>
#include <utility>

#include <spirv_cross/GLSL.std.450.h>

#include "program/cause/environment.hpp"
#include "program/cause/permitted.hpp"

namespace tandem::program {
namespace {

/// A result of `width` bits, or why it is undefined.
struct Outcome {
  std::uint64_t bits = 0;
  const char* undefined = nullptr;
};

/// The operands of one component. Their bits are those of their own widths.
struct Operands {
  std::uint64_t x = 0, y = 0, z = 0, w = 0;
  std::uint32_t width = 32;  ///< of x

  std::int64_t signed_x() const { return sign_extended(x, width); }
  std::int64_t signed_y() const { return sign_extended(y, width); }
  std::int64_t signed_z() const { return sign_extended(z, width); }
};

constexpr const char* zero_divisor = "the divisor is 0";

/// SPIR-V, 3.42.13 "Arithmetic Instructions". Of a negative operand, Vulkan leaves OpSRem and OpSMod open ("Precision
/// of Individual Operations").
Outcome divide(spv::Op op, const Operands& o) {
  if ((o.y & mask_of(o.width)) == 0) return {0, zero_divisor};
  if (op == spv::OpUDiv) return {o.x / o.y};
  if (op == spv::OpUMod) return {o.x % o.y};
  const std::int64_t x = o.signed_x(), y = o.signed_y();
  if (op == spv::OpSDiv) {
    if (y == -1 && x == sign_extended(std::uint64_t{1} << (o.width - 1), o.width)) return {0, "the quotient overflows"};
    return {static_cast<std::uint64_t>(x / y)};
  }
  if (x < 0 || y < 0) return {0, "the remainder of a negative number is undefined"};
  return {o.x % o.y};
}

Outcome shift(spv::Op op, const Operands& o) {
  if (o.y >= o.width) return {0, "the shift is not smaller than the number of bits"};
  if (op == spv::OpShiftLeftLogical) return {o.x << o.y};
  if (op == spv::OpShiftRightLogical) return {o.x >> o.y};
  return {static_cast<std::uint64_t>(o.signed_x() >> o.y)};
}

constexpr const char* long_field = "the bit field ends beyond the last bit";

Outcome insert_field(const Operands& o) {
  if (o.z > o.width || o.w > o.width || o.z + o.w > o.width) return {0, long_field};
  if (o.w == 0) return {o.x};
  const std::uint64_t field = mask_of(static_cast<std::uint32_t>(o.w)) << o.z;
  return {(o.x & ~field) | (o.y << o.z & field)};
}

Outcome extract_field(spv::Op op, const Operands& o) {
  if (o.y > o.width || o.z > o.width || o.y + o.z > o.width) return {0, long_field};
  if (o.z == 0) return {0};
  const auto count = static_cast<std::uint32_t>(o.z);
  const std::uint64_t field = o.x >> o.y & mask_of(count);
  return {op == spv::OpBitFieldSExtract ? static_cast<std::uint64_t>(sign_extended(field, count)) : field};
}

std::uint64_t reversed(std::uint64_t bits, std::uint32_t width) {
  std::uint64_t result = 0;
  for (std::uint32_t i = 0; i < width; ++i) result |= (bits >> i & 1) << (width - 1 - i);
  return result;
}

std::optional<Outcome> core(spv::Op op, const Operands& o) {
  switch (op) {
    case spv::OpIAdd:
      return Outcome{o.x + o.y};
    case spv::OpISub:
      return Outcome{o.x - o.y};
    case spv::OpIMul:
      return Outcome{o.x * o.y};
    case spv::OpSNegate:
      return Outcome{0 - o.x};
    case spv::OpUDiv:
    case spv::OpSDiv:
    case spv::OpUMod:
    case spv::OpSRem:
    case spv::OpSMod:
      return divide(op, o);
    case spv::OpShiftLeftLogical:
    case spv::OpShiftRightLogical:
    case spv::OpShiftRightArithmetic:
      return shift(op, o);
    case spv::OpBitwiseAnd:
    case spv::OpLogicalAnd:
      return Outcome{o.x & o.y};
    case spv::OpBitwiseOr:
    case spv::OpLogicalOr:
      return Outcome{o.x | o.y};
    case spv::OpBitwiseXor:
      return Outcome{o.x ^ o.y};
    case spv::OpNot:
      return Outcome{~o.x};
    case spv::OpLogicalNot:
      return Outcome{o.x ^ 1};
    case spv::OpBitFieldInsert:
      return insert_field(o);
    case spv::OpBitFieldSExtract:
    case spv::OpBitFieldUExtract:
      return extract_field(op, o);
    case spv::OpBitReverse:
      return Outcome{reversed(o.x, o.width)};
    case spv::OpBitCount:
      return Outcome{static_cast<std::uint64_t>(std::popcount(o.x))};
    case spv::OpIEqual:
    case spv::OpLogicalEqual:
      return Outcome{o.x == o.y};
    case spv::OpINotEqual:
    case spv::OpLogicalNotEqual:
      return Outcome{o.x != o.y};
    case spv::OpULessThan:
      return Outcome{o.x < o.y};
    case spv::OpULessThanEqual:
      return Outcome{o.x <= o.y};
    case spv::OpUGreaterThan:
      return Outcome{o.x > o.y};
    case spv::OpUGreaterThanEqual:
      return Outcome{o.x >= o.y};
    case spv::OpSLessThan:
      return Outcome{o.signed_x() < o.signed_y()};
    case spv::OpSLessThanEqual:
      return Outcome{o.signed_x() <= o.signed_y()};
    case spv::OpSGreaterThan:
      return Outcome{o.signed_x() > o.signed_y()};
    case spv::OpSGreaterThanEqual:
      return Outcome{o.signed_x() >= o.signed_y()};
    default:
      return std::nullopt;
  }
}

constexpr const char* crossed_bounds = "the lower bound is above the upper one";

std::optional<Outcome> glsl(std::uint32_t op, const Operands& o) {
  const std::int64_t x = o.signed_x(), y = o.signed_y(), z = o.signed_z();
  const auto bits = [](std::int64_t value) { return Outcome{static_cast<std::uint64_t>(value)}; };
  switch (op) {
    case GLSLstd450SAbs:
      return Outcome{x < 0 ? 0 - o.x : o.x};
    case GLSLstd450SSign:
      return bits(x > 0 ? 1 : x < 0 ? -1 : 0);
    case GLSLstd450UMin:
      return Outcome{std::min(o.x, o.y)};
    case GLSLstd450SMin:
      return bits(std::min(x, y));
    case GLSLstd450UMax:
      return Outcome{std::max(o.x, o.y)};
    case GLSLstd450SMax:
      return bits(std::max(x, y));
    case GLSLstd450UClamp:
      return o.y > o.z ? Outcome{0, crossed_bounds} : Outcome{std::min(std::max(o.x, o.y), o.z)};
    case GLSLstd450SClamp:
      return y > z ? Outcome{0, crossed_bounds} : bits(std::min(std::max(x, y), z));
    case GLSLstd450FindILsb:
      return bits(o.x == 0 ? -1 : std::countr_zero(o.x));
    case GLSLstd450FindUMsb:
      return bits(static_cast<std::int64_t>(std::bit_width(o.x)) - 1);
    case GLSLstd450FindSMsb:
      return bits(static_cast<std::int64_t>(std::bit_width((x < 0 ? ~o.x : o.x) & mask_of(o.width))) - 1);
    default:
      return std::nullopt;
  }
}

Operands operands_at(const Call& call, std::size_t component) {
  Operands o;
  const std::array<std::uint64_t*, 4> all = {&o.x, &o.y, &o.z, &o.w};
  for (std::size_t i = 0; i < call.operands.size() && i < all.size(); ++i) *all[i] = call.operand(i, component).bits;
  o.width = call.operand(0, component).width;
  return o;
}

std::optional<Outcome> outcome(const Call& call, const Operands& o) {
  return call.instruction.op == spv::OpExtInst ? glsl(call.glsl, o) : core(call.instruction.op, o);
}

bool any_undefined(const Call& call, std::size_t component) {
  for (std::size_t i = 0; i < call.operands.size(); ++i)
    if (call.operand(i, component).undefined) return true;
  return false;
}

/// RelaxedPrecision: 16 bits of the operands suffice, and 16 bits of the result (SPIR-V, 2.14 "Relaxed Precision").
void relax(const Call& call, Operands o, Permitted& permitted) {
  o.x &= 0xffff;
  o.y &= 0xffff;
  o.z &= 0xffff;
  o.width = 16;
  const Outcome relaxed = *outcome(call, o);
  permitted.reason = "relaxed precision is 16 bits";
  permitted.others.push_back(relaxed.bits & 0xffff);
  permitted.others.push_back(static_cast<std::uint64_t>(sign_extended(relaxed.bits, 16)) & 0xffffffff);
  permitted.open = relaxed.undefined != nullptr;
}

bool any_or_all(const Scalars& operand, bool all) {
  for (const Scalar& each : operand)
    if ((each.bits != 0) != all) return !all;
  return all;
}

}  // namespace

std::optional<Permissions> permitted_integers(const Call& call) {
  const spv::Op op = call.instruction.op;
  Permissions permissions;
  if (op == spv::OpAny || op == spv::OpAll) {
    Scalar result = call.result_scalar(0);
    result.bits = any_or_all(call.operand(0), op == spv::OpAll) ? 1 : 0;
    for (const Scalar& each : call.operand(0)) result.undefined |= each.undefined;
    return Permissions{exactly_this(result)};
  }
  if (call.operands.empty() || !outcome(call, {.y = 1}) || call.operand(0)[0].kind == ComponentKind::floating)
    return std::nullopt;
  const bool relaxed = is_decorated(call.module, call.instruction.result, spv::DecorationRelaxedPrecision);
  for (std::size_t i = 0; i < call.result.size(); ++i) {
    Scalar result = call.result_scalar(i);
    const Operands operands = operands_at(call, i);
    const Outcome exact = *outcome(call, operands);
    result.bits = exact.bits & (result.kind == ComponentKind::boolean ? 1 : mask_of(result.width));
    if (any_undefined(call, i)) {
      permissions.push_back(undefined(result, undefined_operand));
    } else if (exact.undefined != nullptr) {
      permissions.push_back(undefined(result, exact.undefined));
    } else {
      permissions.push_back(exactly_this(result));
      if (relaxed && result.width == 32 && operands.width == 32) relax(call, operands, permissions.back());
    }
  }
  return permissions;
}

}  // namespace tandem::program
