#include "program/cause/number/elementary.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tandem::program {
namespace {

using rhi::FloatOperation;
using Function = long double (*)(long double);

constexpr const char* no_circle = "sin and cos have no bound outside of [-pi, pi]";

Real apply(Function function, Real x) { return function(static_cast<long double>(x)); }

/// What the tables allow at x, where the function is `value`.
Real error_at(const Rules& rules, FloatOperation operation, Real x, Real value, Real y = 0) {
  if (!is_finite(value) || absolute(value) > 2 * largest_finite(rules.format)) return 0;
  return rhi::allowed_error(operation, rules.format.width, static_cast<double>(x), static_cast<double>(y),
                            static_cast<double>(value));
}

/// A function that never decreases.
Range increasing(const Rules& rules, FloatOperation operation, Function function, const Range& given) {
  Range x = given;
  if (x.may_be_zero) {
    x.low = std::min<Real>(x.low, 0);
    x.high = std::max<Real>(x.high, 0);
  }
  Range result{.exact = apply(function, x.exact), .low = apply(function, x.low), .high = apply(function, x.high)};
  if (x.open) return open(result.exact, x.why);
  const Real low_error = error_at(rules, operation, x.low, result.low);
  const Real high_error = error_at(rules, operation, x.high, result.high);
  result.low -= low_error;
  result.high += high_error;
  return within(rules, result, 0);
}

Range logarithm(const Rules& rules, FloatOperation operation, Function function, const Range& x) {
  if (x.open) return open(apply(function, x.exact), x.why);
  if (!(x.low > 0) || x.may_be_zero)
    return open(apply(function, x.exact), "the logarithm of what may be zero or negative is open");
  return increasing(rules, operation, function, x);
}

Range circular(const Rules& rules, FloatOperation operation, Function function, const Range& x) {
  const Real exact = apply(function, x.exact);
  if (x.open) return open(exact, x.why);
  const Real error = error_at(rules, operation, x.exact, exact);
  if (is_infinite(error)) return open(exact, no_circle);
  return within(rules, exactly(exact), error + (x.high - x.low));  // no slope is steeper than 1
}

}  // namespace

Range exp_of(const Rules& rules, const Range& x) { return increasing(rules, FloatOperation::exp, std::exp, x); }
Range exp2_of(const Rules& rules, const Range& x) { return increasing(rules, FloatOperation::exp2, std::exp2, x); }
Range log_of(const Rules& rules, const Range& x) { return logarithm(rules, FloatOperation::log, std::log, x); }
Range log2_of(const Rules& rules, const Range& x) { return logarithm(rules, FloatOperation::log2, std::log2, x); }
Range sin_of(const Rules& rules, const Range& x) { return circular(rules, FloatOperation::sin, std::sin, x); }
Range cos_of(const Rules& rules, const Range& x) { return circular(rules, FloatOperation::cos, std::cos, x); }
Range atan_of(const Rules& rules, const Range& x) { return increasing(rules, FloatOperation::atan, std::atan, x); }

Range atan2_of(const Rules& rules, const Range& y, const Range& x) {
  const auto angle = [](Real b, Real a) -> Real {
    return std::atan2(static_cast<long double>(b), static_cast<long double>(a));
  };
  const Real exact = angle(y.exact, x.exact);
  if (y.open || x.open) return open(exact, y.open ? y.why : x.why);
  const Real y_low = y.may_be_zero ? std::min<Real>(y.low, 0) : y.low;
  const Real y_high = y.may_be_zero ? std::max<Real>(y.high, 0) : y.high;
  const Real x_low = x.may_be_zero ? std::min<Real>(x.low, 0) : x.low;
  const Real x_high = x.may_be_zero ? std::max<Real>(x.high, 0) : x.high;
  if (y_low <= 0 && y_high >= 0 && x_low <= 0 && x_high >= 0)
    return open(exact, "the angle of what may be (0, 0) is open");
  Range result{.exact = exact, .low = exact, .high = exact};
  // In a box without the origin that does not cross the negative half of the x axis, the corners have the extremes.
  for (const Real b : {y_low, y_high})
    for (const Real a : {x_low, x_high}) {
      const Real value = angle(b, a), error = error_at(rules, FloatOperation::atan2, b, value, a);
      result.low = std::min(result.low, value - error);
      result.high = std::max(result.high, value + error);
    }
  const bool jumps = x_low < 0 && y_high >= 0 && (y_low < 0 || is_negative(y_low));
  if (jumps) {
    const Real bound = std::max(absolute(result.low), absolute(result.high));
    const Real half_turn = std::max(bound, angle(0, -1));
    result.low = -half_turn;
    result.high = half_turn;
  }
  return within(rules, result, 0);
}

}  // namespace tandem::program
