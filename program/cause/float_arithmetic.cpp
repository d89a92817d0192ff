#include <array>

#include "program/cause/environment.hpp"
#include "program/cause/permitted.hpp"
#include "program/cause/rearrangement.hpp"

/// OpFAdd to OpFNegate: the table "Precision of core SPIR-V Instructions".
namespace tandem::program {
namespace {

/// The remainder of real numbers, which a float always holds. floored: with the divisor's sign, else the dividend's.
Real exact_remainder(Real x, Real y, bool by_floor) {
  if (!is_finite(x) || y == 0 || is_nan(y)) return not_a_number();
  if (is_infinite(y)) return x;
  Real rest = absolute(x);
  const Real divisor = absolute(y);
  // Long division, a power of two at a time: the quotient itself may have thousands of bits.
  while (rest >= divisor) {
    Real part = scaled(divisor, exponent_of(rest) - exponent_of(divisor));
    if (part > rest) part /= 2;
    rest -= part;
  }
  if (x < 0) rest = -rest;
  return by_floor && rest != 0 && (rest < 0) != (y < 0) ? rest + y : rest;
}

/// "Inherited from x - y * trunc(x / y)", and floor.
Range remainder(const Rules& rules, const Range& x, const Range& y, bool by_floor) {
  const Range quotient = divide(rules, x, y);
  const Range whole = by_floor ? floor_of(quotient) : truncate(quotient);
  Range result = subtract(rules, x, multiply(rules, y, whole));
  result.exact = exact_remainder(x.exact, y.exact, by_floor);
  result.tail = 0;
  return inherited(result);
}

std::optional<Range> apply(spv::Op op, const Rules& rules, std::span<const Range> x) {
  switch (op) {
    case spv::OpFAdd:
      return add(rules, x[0], x[1]);
    case spv::OpFSub:
      return subtract(rules, x[0], x[1]);
    case spv::OpFMul:
    case spv::OpVectorTimesScalar:
    case spv::OpMatrixTimesScalar:
      return multiply(rules, x[0], x[1]);
    case spv::OpFDiv:
      return divide(rules, x[0], x[1]);
    case spv::OpFRem:
    case spv::OpFMod:
      return remainder(rules, x[0], x[1], op == spv::OpFMod);
    case spv::OpFNegate:
      return convert(rules, negate(x[0]));
    default:
      return std::nullopt;
  }
}

bool is_arithmetic(spv::Op op) {
  switch (op) {
    case spv::OpFAdd:
    case spv::OpFSub:
    case spv::OpFMul:
    case spv::OpVectorTimesScalar:
    case spv::OpMatrixTimesScalar:
    case spv::OpFDiv:
    case spv::OpFRem:
    case spv::OpFMod:
    case spv::OpFNegate:
      return true;
    default:
      return false;
  }
}

constexpr const char* rearranged = "without NoContraction, instructions may be fused and rearranged";

/// Adds what results when the instruction is combined with those that made its operands.
void permit_combinations(const Call& call, std::size_t component, std::span<const Scalar> operands,
                         Permitted& permitted) {
  if (operands.size() != 2 || permitted.open || permitted.undefined) return;
  if (!may_combine(call.module, call.instruction)) return;
  std::array<std::optional<Range>, 2> sources;
  for (std::size_t i = 0; i < 2; ++i) sources[i] = unrounded(call, call.ids[i], component, operands[i]);
  for (unsigned which = 1; which < 4; ++which) {
    if (((which & 1) != 0 && !sources[0]) || ((which & 2) != 0 && !sources[1])) continue;
    std::array<Range, 2> ranges;
    for (unsigned i = 0; i < 2; ++i)
      ranges[i] = (which >> i & 1) != 0 ? *sources[i] : operand(permitted.rules, real_of(operands[i]));
    Range range = *apply(call.instruction.op, permitted.rules, ranges);
    if (range.open) continue;
    range.why = rearranged;
    permitted.ranges.push_back(range);
  }
}

}  // namespace

std::optional<Permissions> permitted_float_arithmetic(const Call& call) {
  const spv::Op op = call.instruction.op;
  if (!is_arithmetic(op)) return std::nullopt;
  Permissions permissions;
  for (std::size_t i = 0; i < call.result.size(); ++i) {
    const Scalar like = call.result_scalar(i);
    Scalars operands;
    for (std::size_t k = 0; k < call.operands.size(); ++k) operands.push_back(call.operand(k, i));
    if (operands.size() == 2 && real_of(operands[1]) == 0 && (op == spv::OpFRem || op == spv::OpFMod)) {
      permissions.push_back(undefined(like, "the divisor is 0"));
      continue;
    }
    permissions.push_back(computed(rules_of(call.module, call.instruction, like.width), like.width, operands,
                                   [&](const Rules& rules, std::span<const Range> x) { return *apply(op, rules, x); }));
    permit_combinations(call, i, operands, permissions.back());
  }
  return permissions;
}

}  // namespace tandem::program
