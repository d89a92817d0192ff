#include <cmath>

#include <spirv_cross/GLSL.std.450.h>

#include "program/cause/environment.hpp"
#include "program/cause/number/elementary.hpp"
#include "program/cause/permitted.hpp"

/// GLSL.std.450 from Sin to InverseSqrt, by the table "Precision of GLSL.std.450 Instructions".
namespace tandem::program {
namespace {

Range half_of(const Rules& rules, const Range& x) { return multiply(rules, x, exactly(0.5)); }

/// With the exact value that the formula's intermediate steps are too short for.
Range with_exact(Range range, long double exact) {
  range.exact = exact;
  range.tail = 0;
  return inherited(range);
}

Range sinh_of(const Rules& rules, const Range& x) {
  return half_of(rules, subtract(rules, exp_of(rules, x), exp_of(rules, negate(x))));
}

Range cosh_of(const Rules& rules, const Range& x) {
  return half_of(rules, add(rules, exp_of(rules, x), exp_of(rules, negate(x))));
}

/// sqrt(x * x + constant)
Range root_of_square(const Rules& rules, const Range& x, int constant) {
  return square_root(rules, add(rules, multiply(rules, x, x), exactly(constant)));
}

/// sqrt(1 - x * x)
Range other_side(const Rules& rules, const Range& x) {
  return square_root(rules, subtract(rules, exactly(1), multiply(rules, x, x)));
}

Range pow_of(const Rules& rules, const Range& x, const Range& y) {
  // log2(0) is open, but pow itself is only where y <= 0.
  if (x.low == 0 && x.high == 0) return exactly(0);
  const Range result = exp2_of(rules, multiply(rules, y, log2_of(rules, x)));
  return with_exact(result, std::pow(static_cast<long double>(x.exact), static_cast<long double>(y.exact)));
}

std::optional<Range> evaluate(std::uint32_t op, const Rules& rules, std::span<const Range> operands) {
  const Range& x = operands[0];
  const auto value = static_cast<long double>(x.exact);
  switch (op) {
    case GLSLstd450Sin:
      return sin_of(rules, x);
    case GLSLstd450Cos:
      return cos_of(rules, x);
    case GLSLstd450Tan:
      return with_exact(divide(rules, sin_of(rules, x), cos_of(rules, x)), std::tan(value));
    case GLSLstd450Asin:
      return with_exact(atan2_of(rules, x, other_side(rules, x)), std::asin(value));
    case GLSLstd450Acos:
      return with_exact(atan2_of(rules, other_side(rules, x), x), std::acos(value));
    case GLSLstd450Atan:
      return atan_of(rules, x);
    case GLSLstd450Atan2:
      return atan2_of(rules, x, operands[1]);
    case GLSLstd450Sinh:
      return with_exact(sinh_of(rules, x), std::sinh(value));
    case GLSLstd450Cosh:
      return with_exact(cosh_of(rules, x), std::cosh(value));
    case GLSLstd450Tanh:
      return with_exact(divide(rules, sinh_of(rules, x), cosh_of(rules, x)), std::tanh(value));
    case GLSLstd450Asinh:
      return with_exact(log_of(rules, add(rules, x, root_of_square(rules, x, 1))), std::asinh(value));
    case GLSLstd450Acosh:
      return with_exact(log_of(rules, add(rules, x, root_of_square(rules, x, -1))), std::acosh(value));
    case GLSLstd450Atanh: {
      const Range quotient = divide(rules, add(rules, exactly(1), x), subtract(rules, exactly(1), x));
      return with_exact(half_of(rules, log_of(rules, quotient)), std::atanh(value));
    }
    case GLSLstd450Pow:
      return pow_of(rules, x, operands[1]);
    case GLSLstd450Exp:
      return exp_of(rules, x);
    case GLSLstd450Exp2:
      return exp2_of(rules, x);
    case GLSLstd450Log:
      return log_of(rules, x);
    case GLSLstd450Log2:
      return log2_of(rules, x);
    case GLSLstd450Sqrt:
      return square_root(rules, x);
    case GLSLstd450InverseSqrt:
      return inverse_sqrt(rules, x);
    default:
      return std::nullopt;
  }
}

/// The domains, by the instructions' descriptions in GLSL.std.450.
const char* why_undefined(std::uint32_t op, Real x, Real y) {
  switch (op) {
    case GLSLstd450Asin:
    case GLSLstd450Acos:
      return absolute(x) > 1 ? "the operand is outside of [-1, 1]" : nullptr;
    case GLSLstd450Acosh:
      return x < 1 ? "the operand is less than 1" : nullptr;
    case GLSLstd450Atanh:
      return absolute(x) >= 1 ? "the operand is outside of (-1, 1)" : nullptr;
    case GLSLstd450Atan2:
      return x == 0 && y == 0 ? "both operands are 0" : nullptr;
    case GLSLstd450Pow:
      if (x < 0) return "the base is negative";
      return x == 0 && y <= 0 ? "the base is 0 and the exponent is not positive" : nullptr;
    case GLSLstd450Log:
    case GLSLstd450Log2:
    case GLSLstd450InverseSqrt:
      return x <= 0 ? "the operand is not positive" : nullptr;
    case GLSLstd450Sqrt:
      return x < 0 ? "the operand is negative" : nullptr;
    default:
      return nullptr;
  }
}

bool is_function(std::uint32_t op) {
  return (op >= GLSLstd450Sin && op <= GLSLstd450Atanh) || (op >= GLSLstd450Atan2 && op <= GLSLstd450InverseSqrt);
}

}  // namespace

std::optional<Permissions> permitted_glsl_functions(const Call& call) {
  if (!is_function(call.glsl)) return std::nullopt;
  Permissions permissions;
  for (std::size_t i = 0; i < call.result.size(); ++i) {
    const Scalar like = call.result_scalar(i);
    const Rules rules = rules_of(call.module, call.instruction, like.width);
    Scalars operands;
    for (std::size_t k = 0; k < call.operands.size(); ++k) operands.push_back(call.operand(k, i));
    const Scalar& x = operands.front();
    // A denormal that is flushed is outside of a domain without 0.
    const bool flushes = rules.may_flush && is_denormal(real_of(x), format_of(x.width));
    const Real y = operands.size() > 1 ? real_of(operands[1]) : Real{0};
    const char* why = why_undefined(call.glsl, real_of(x), y);
    if (why == nullptr && flushes) why = why_undefined(call.glsl, 0, y);
    if (why != nullptr) {
      permissions.push_back(undefined(like, why));
      continue;
    }
    permissions.push_back(computed(rules, like.width, operands, [&](const Rules& r, std::span<const Range> all) {
      return *evaluate(call.glsl, r, all);
    }));
  }
  return permissions;
}

}  // namespace tandem::program
