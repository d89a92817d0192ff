#include <algorithm>
#include <array>

#include "program/cause/environment.hpp"
#include "program/cause/permitted.hpp"

/// Comparisons of floats, OpIsNan and OpIsInf.
namespace tandem::program {
namespace {

/// Of numbers; NaN is handled before.
std::optional<bool> compare(spv::Op op, Real x, Real y) {
  switch (op) {
    case spv::OpFOrdEqual:
    case spv::OpFUnordEqual:
      return x == y;
    case spv::OpFOrdNotEqual:
    case spv::OpFUnordNotEqual:
      return x != y;
    case spv::OpFOrdLessThan:
    case spv::OpFUnordLessThan:
      return x < y;
    case spv::OpFOrdLessThanEqual:
    case spv::OpFUnordLessThanEqual:
      return x <= y;
    case spv::OpFOrdGreaterThan:
    case spv::OpFUnordGreaterThan:
      return x > y;
    case spv::OpFOrdGreaterThanEqual:
    case spv::OpFUnordGreaterThanEqual:
      return x >= y;
    default:
      return std::nullopt;
  }
}

/// Whether 16 bits of the operands leave their order open.
bool may_be_equal(Real x, Real y) {
  const Format half = format_of(16);
  return rounded_down(x, half) <= rounded_up(y, half) && rounded_down(y, half) <= rounded_up(x, half);
}

Permitted compared(const Call& call, const Scalar& like, const Scalar& x, const Scalar& y) {
  const Real real_x = real_of(x), real_y = real_of(y);
  if (!x.undefined && !y.undefined && (is_nan(real_x) || is_nan(real_y)))
    return undefined(like, "an operand is NaN, which comparisons need not respect");
  const std::array<Scalar, 2> operands = {x, y};
  Permitted result = decided(
      rules_of(call.module, call.instruction, x.width), like, operands,
      [&](std::span<const Real> reals) { return std::uint64_t{*compare(call.instruction.op, reals[0], reals[1])}; });
  if (is_infinite(real_x) || is_infinite(real_y)) {
    result.open = true;
    result.reason = "comparisons need not respect infinity";
  }
  const auto is_relaxed = [&](std::uint32_t id) {
    return is_decorated(call.module, id, spv::DecorationRelaxedPrecision);
  };
  if (x.width == 32 && (is_relaxed(call.ids[0]) || is_relaxed(call.ids[1])) && may_be_equal(real_x, real_y)) {
    result.open = true;
    result.reason = "the operands have relaxed precision";
  }
  return result;
}

Permitted tested(const Call& call, Scalar like, const Scalar& x) {
  const Real real = real_of(x);
  like.bits = call.instruction.op == spv::OpIsNan ? is_nan(real) : is_infinite(real);
  like.undefined = x.undefined;
  Permitted result = exactly_this(like);
  if (!is_finite(real) && !x.undefined) {
    result.open = true;
    result.reason = "NaN and infinity need not be respected";
  }
  return result;
}

}  // namespace

std::optional<Permissions> permitted_comparisons(const Call& call) {
  const spv::Op op = call.instruction.op;
  const bool tests = op == spv::OpIsNan || op == spv::OpIsInf;
  if (!tests && !compare(op, 0, 0)) return std::nullopt;
  Permissions permissions;
  for (std::size_t i = 0; i < call.result.size(); ++i) {
    const Scalar like = call.result_scalar(i);
    permissions.push_back(tests ? tested(call, like, call.operand(0, i))
                                : compared(call, like, call.operand(0, i), call.operand(1, i)));
  }
  return permissions;
}

}  // namespace tandem::program
