#include <algorithm>
#include <array>

#include <spirv_cross/GLSL.std.450.h>

#include "program/cause/environment.hpp"
#include "program/cause/permitted.hpp"

/// GLSL.std.450 from Round to NClamp: "correctly rounded" in the table "Precision of GLSL.std.450 Instructions", or
/// inherited from sums and products.
namespace tandem::program {
namespace {

constexpr long double pi = 3.14159265358979323846264338327950288L;

/// A function that never decreases, of both bounds.
template <typename Function>
Range monotone(const Range& x, Function&& function) {
  return {.exact = function(x.exact), .low = function(x.low), .high = function(x.high)};
}

Real round_even(Real x) {
  const Real down = floored(x), rest = x - down;
  if (rest != 0.5) return rest < 0.5 ? down : down + 1;
  return floored(down / 2) * 2 == down ? down : down + 1;
}

/// Halves go either way.
Range round_either(const Range& x) {
  return {.exact = round_even(x.exact), .low = -floored(-(x.low - 0.5)), .high = floored(x.high + 0.5)};
}

Range magnitude(const Range& x) { return maximum(x, negate(x)); }

Real sign_of(Real x) { return x > 0 ? 1 : x < 0 ? -1 : x; }

/// "Inherited from x * C", C a correctly rounded constant.
Range times_constant(const Rules& rules, const Range& x, Real constant) {
  Range result = multiply(rules, x, convert(rules, exactly(constant)));
  result.exact = x.exact * constant;
  return inherited(result);
}

/// "Inherited from x * (1 - a) + y * a". Distributivity makes x + (y - x) * a of it.
Range mix(const Rules& rules, const Range& x, const Range& y, const Range& a) {
  const Range first = add(rules, multiply(rules, x, subtract(rules, exactly(1), a)), multiply(rules, y, a));
  const Range second = add(rules, x, multiply(rules, subtract(rules, y, x), a));
  return inherited(either(first, second));
}

Range step(const Range& edge, const Range& x) {
  Range result = exactly(x.exact < edge.exact ? 0 : 1);
  result.low = x.low < edge.high ? 0 : 1;
  result.high = x.high < edge.low ? 0 : 1;
  return result;
}

Range clamp(const Range& x, const Range& low, const Range& high) { return minimum(maximum(x, low), high); }

/// "Inherited from t * t * (3 - 2 * t), where t = clamp((x - edge0) / (edge1 - edge0), 0, 1)".
Range smoothstep(const Rules& rules, const Range& edge0, const Range& edge1, const Range& x) {
  const Range quotient = divide(rules, subtract(rules, x, edge0), subtract(rules, edge1, edge0));
  const Range t = clamp(quotient, exactly(0), exactly(1));
  const Range rest = subtract(rules, exactly(3), multiply(rules, exactly(2), t));
  return inherited(multiply(rules, multiply(rules, t, t), rest));
}

std::optional<Range> evaluate(std::uint32_t op, const Rules& rules, std::span<const Range> x) {
  switch (op) {
    case GLSLstd450Round:
      return round_either(x[0]);
    case GLSLstd450RoundEven:
      return monotone(x[0], round_even);
    case GLSLstd450Trunc:
      return truncate(x[0]);
    case GLSLstd450Floor:
      return floor_of(x[0]);
    case GLSLstd450Ceil:
      return negate(floor_of(negate(x[0])));
    case GLSLstd450FAbs:
      return magnitude(x[0]);
    case GLSLstd450FSign:
      return monotone(x[0], sign_of);
    case GLSLstd450Fract:
      return subtract(rules, x[0], floor_of(x[0]));
    case GLSLstd450Radians:
      return times_constant(rules, x[0], Real{pi} / 180);
    case GLSLstd450Degrees:
      return times_constant(rules, x[0], 180 / Real{pi});
    case GLSLstd450FMin:
    case GLSLstd450NMin:
      return minimum(x[0], x[1]);
    case GLSLstd450FMax:
    case GLSLstd450NMax:
      return maximum(x[0], x[1]);
    case GLSLstd450FClamp:
    case GLSLstd450NClamp:
      return clamp(x[0], x[1], x[2]);
    case GLSLstd450FMix:
      return mix(rules, x[0], x[1], x[2]);
    case GLSLstd450Step:
      return step(x[0], x[1]);
    case GLSLstd450SmoothStep:
      return smoothstep(rules, x[0], x[1], x[2]);
    case GLSLstd450Fma:  // "inherited from OpFMul followed by OpFAdd"
      return inherited(add(rules, multiply(rules, x[0], x[1]), x[2]));
    default:
      return std::nullopt;
  }
}

std::size_t operand_count(std::uint32_t op) {
  switch (op) {
    case GLSLstd450Round:
    case GLSLstd450RoundEven:
    case GLSLstd450Trunc:
    case GLSLstd450Floor:
    case GLSLstd450Ceil:
    case GLSLstd450FAbs:
    case GLSLstd450FSign:
    case GLSLstd450Fract:
    case GLSLstd450Radians:
    case GLSLstd450Degrees:
      return 1;
    case GLSLstd450FMin:
    case GLSLstd450NMin:
    case GLSLstd450FMax:
    case GLSLstd450NMax:
    case GLSLstd450Step:
      return 2;
    case GLSLstd450FClamp:
    case GLSLstd450NClamp:
    case GLSLstd450FMix:
    case GLSLstd450SmoothStep:
    case GLSLstd450Fma:
      return 3;
    default:
      return 0;
  }
}

const char* why_undefined(std::uint32_t op, std::span<const Scalar> x) {
  const bool any_nan = std::any_of(x.begin(), x.end(), [](const Scalar& s) { return is_nan(real_of(s)); });
  switch (op) {
    case GLSLstd450FMin:
    case GLSLstd450FMax:
    case GLSLstd450FClamp:
    case GLSLstd450Step:
    case GLSLstd450SmoothStep:
      if (any_nan) return "an operand is NaN";
      break;
    default:
      break;
  }
  if ((op == GLSLstd450FClamp || op == GLSLstd450NClamp) && real_of(x[1]) > real_of(x[2]))
    return "the lower bound is above the upper one";
  if (op == GLSLstd450SmoothStep && real_of(x[0]) >= real_of(x[1])) return "the first edge is not below the second one";
  return nullptr;
}

/// NMin, NMax and NClamp take the other operand's value in place of NaN. Whether there was one.
bool replace_nan(std::uint32_t op, Scalars& x) {
  if (op != GLSLstd450NMin && op != GLSLstd450NMax && op != GLSLstd450NClamp) return false;
  bool found = false;
  for (std::size_t i = 0; i < 2; ++i)
    if (is_nan(real_of(x[i]))) {
      x[i] = x[1 - i];
      found = true;
    }
  return found;
}

/// x * 2^exponent: "correctly rounded", and open where the exponent is large (GLSL.std.450, Ldexp).
Permitted ldexp(const Rules& rules, const Scalar& like, const Scalar& x, const Scalar& exponent) {
  if (x.undefined || exponent.undefined) return undefined(like, undefined_operand);
  const Format format = format_of(like.width);
  const std::int64_t power = std::clamp<std::int64_t>(signed_of(exponent), -9000, 9000);
  if (power > format.largest_exponent + 1) return undefined(like, "the exponent is too large");
  if (is_finite(real_of(x)) && !is_finite(rounded_to_nearest(scaled(real_of(x), static_cast<int>(power)), format)))
    return undefined(like, "the result is too large");
  return computed(rules, like.width, {&x, 1}, [&](const Rules& r, std::span<const Range> operands) {
    const int by = static_cast<int>(power);
    Range result = monotone(operands[0], [by](Real value) { return scaled(value, by); });
    result = convert(r, result);
    result.may_be_zero |= power < format.smallest_exponent;
    return result;
  });
}

/// frexp and modf: a float, then, of the forms with a structure, the exponent or the whole part.
Permissions split(const Call& call) {
  const bool takes_exponent = call.glsl == GLSLstd450Frexp || call.glsl == GLSLstd450FrexpStruct;
  const std::size_t count = call.operand(0).size();
  Permissions permissions;
  for (std::size_t i = 0; i < call.result.size(); ++i) {
    const Scalar& x = call.operand(0)[i % count];
    const Scalar like = call.result_scalar(i);
    const Rules rules = rules_of(call.module, call.instruction, x.width);
    if (takes_exponent && !x.undefined && !is_finite(real_of(x))) {
      permissions.push_back(undefined(like, "the operand is NaN or infinite"));
    } else if (takes_exponent && i >= count) {
      permissions.push_back(decided(rules, like, {&x, 1}, [](std::span<const Real> reals) {
        return static_cast<std::uint64_t>(reals[0] == 0 ? 0 : exponent_of(reals[0]) + 1);
      }));
    } else {
      permissions.push_back(
          computed(rules, like.width, {&x, 1}, [&](const Rules& r, std::span<const Range> operands) -> Range {
            const Range& value = operands[0];
            if (takes_exponent)
              return monotone(value, [](Real v) { return v == 0 ? v : scaled(v, -exponent_of(v) - 1); });
            return i < count ? subtract(r, value, truncate(value)) : truncate(value);
          }));
    }
  }
  return permissions;
}

}  // namespace

std::optional<Permissions> permitted_glsl_common(const Call& call) {
  switch (call.glsl) {
    case GLSLstd450Frexp:
    case GLSLstd450FrexpStruct:
    case GLSLstd450Modf:
    case GLSLstd450ModfStruct:
      return split(call);
    default:
      break;
  }
  const std::size_t count = operand_count(call.glsl);
  if (count == 0 && call.glsl != GLSLstd450Ldexp) return std::nullopt;
  Permissions permissions;
  for (std::size_t i = 0; i < call.result.size(); ++i) {
    const Scalar like = call.result_scalar(i);
    const Rules rules = rules_of(call.module, call.instruction, like.width);
    if (call.glsl == GLSLstd450Ldexp) {
      permissions.push_back(ldexp(rules, like, call.operand(0, i), call.operand(1, i)));
      continue;
    }
    Scalars operands;
    for (std::size_t k = 0; k < count; ++k) operands.push_back(call.operand(k, i));
    if (const char* why = why_undefined(call.glsl, operands)) {
      permissions.push_back(undefined(like, why));
      continue;
    }
    const bool ignores_nan = replace_nan(call.glsl, operands);
    permissions.push_back(computed(rules, like.width, operands, [&](const Rules& r, std::span<const Range> x) {
      return *evaluate(call.glsl, r, x);
    }));
    if (!ignores_nan || permissions.back().undefined) continue;
    permissions.back().open = true;
    permissions.back().reason = "NaN need not be respected";
  }
  return permissions;
}

}  // namespace tandem::program
