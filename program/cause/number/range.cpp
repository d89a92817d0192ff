#include "program/cause/number/range.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace tandem::program {
namespace {

/// With the zeros that flushed denormals are.
Range used(Range x) {
  if (x.may_be_zero) {
    x.low = std::min<Real>(x.low, 0);
    x.high = std::max<Real>(x.high, 0);
  }
  return x;
}

bool are_numbers(const Range& x) { return !is_nan(x.low) && !is_nan(x.high); }

constexpr const char* no_number = "a step of the formula may be NaN";

Range first_open(const Range& x, const Range& y, Real exact) { return open(exact, x.open ? x.why : y.why); }

void mark_flush(const Rules& rules, Range& x) {
  const Real normal = smallest_normal(rules.format);
  x.may_be_zero = rules.may_flush && x.low < normal && x.high > -normal;
}

/// Rounds the bounds outwards, or as the entry point's execution mode says. The tails are those of the bounds.
Range rounded(const Rules& rules, Range x, Real low_tail, Real high_tail) {
  if (!are_numbers(x)) return open(x.exact, no_number);
  const Format& format = rules.format;
  switch (rules.relaxed ? Rounding::unspecified : rules.rounding) {
    case Rounding::unspecified:
      x.low = rounded_down(x.low, format, low_tail);
      x.high = rounded_up(x.high, format, high_tail);
      break;
    case Rounding::to_nearest:
      x.low = rounded_to_nearest(x.low, format, low_tail);
      x.high = rounded_to_nearest(x.high, format, high_tail);
      break;
    case Rounding::to_zero:
      x.low = rounded_to_zero(x.low, format, low_tail);
      x.high = rounded_to_zero(x.high, format, high_tail);
      break;
  }
  mark_flush(rules, x);
  return x;
}

/// The smallest and the largest of what the four pairs of bounds make.
template <typename Operation>
Range of_corners(const Range& x, const Range& y, Operation&& operation) {
  const std::array<Real, 4> corners = {operation(x.low, y.low), operation(x.low, y.high), operation(x.high, y.low),
                                       operation(x.high, y.high)};
  Range result{.low = corners[0], .high = corners[0]};
  for (const Real corner : corners) {
    if (is_nan(corner)) result.low = result.high = corner;
    if (is_nan(result.low)) break;
    result.low = std::min(result.low, corner);
    result.high = std::max(result.high, corner);
  }
  return result;
}

}  // namespace

Range exactly(Real value) { return {.exact = value, .low = value, .high = value}; }

Range open(Real exact, const char* why) {
  return {.exact = exact, .low = -infinity(), .high = infinity(), .open = true, .why = why};
}

Range operand(const Rules& rules, Real value) {
  Range x = exactly(value);
  // What has relaxed precision may be computed with 16 bits: its operands are rounded first.
  if (rules.relaxed && is_finite(value)) {
    x.low = rounded_down(value, rules.format);
    x.high = rounded_up(value, rules.format);
    mark_flush(rules, x);
  }
  return x;
}

Range either(const Range& first, const Range& second) {
  if (first.open || second.open) return first_open(first, second, first.exact);
  Range result = first;
  result.low = std::min(first.low, second.low);
  result.high = std::max(first.high, second.high);
  result.may_be_zero = first.may_be_zero || second.may_be_zero;
  return result;
}

Range inherited(const Range& range) {
  if (range.open || !is_finite(range.exact)) return range;
  const Range bounds = used(range);
  const Real error = std::max(absolute(bounds.high - range.exact), absolute(range.exact - bounds.low));
  Range result = range;
  result.low = range.exact - error;
  result.high = range.exact + error;
  return result;
}

Range within(const Rules& rules, const Range& range, Real error) {
  if (range.open) return range;
  Range result = range;
  result.low -= error;
  result.high += error;
  if (!are_numbers(result)) return open(range.exact, no_number);
  mark_flush(rules, result);
  return result;
}

Range add(const Rules& rules, const Range& x_given, const Range& y_given) {
  const Range x = used(x_given), y = used(y_given);
  Range sum{.exact = x.exact + y.exact, .low = x.low + y.low, .high = x.high + y.high};
  const auto tail = [](Real a, Real b) { return is_finite(a + b) ? sum_tail(a, b) : Real{0}; };
  sum.tail = tail(x.exact, y.exact);
  if (x.open || y.open) return first_open(x, y, sum.exact);
  return rounded(rules, sum, tail(x.low, y.low), tail(x.high, y.high));
}

Range subtract(const Rules& rules, const Range& x, const Range& y) { return add(rules, x, negate(y)); }

Range multiply(const Rules& rules, const Range& x_given, const Range& y_given) {
  const Range x = used(x_given), y = used(y_given);
  Range product = of_corners(x, y, [](Real a, Real b) { return a * b; });
  product.exact = x.exact * y.exact;
  if (x.open || y.open) return first_open(x, y, product.exact);
  return rounded(rules, product, 0, 0);
}

Range convert(const Rules& rules, const Range& x_given) {
  const Range x = used(x_given);
  return x.open ? x : rounded(rules, x, x.tail, x.tail);
}

Range negate(const Range& x) {
  Range result = x;
  result.exact = -x.exact;
  result.tail = -x.tail;
  result.low = -x.high;
  result.high = -x.low;
  return result;
}

Range minimum(const Range& x_given, const Range& y_given) {
  const Range x = used(x_given), y = used(y_given);
  const Real exact = y.exact < x.exact ? y.exact : x.exact;
  if (x.open || y.open) return first_open(x, y, exact);
  return {.exact = exact, .low = std::min(x.low, y.low), .high = std::min(x.high, y.high)};
}

Range maximum(const Range& x, const Range& y) { return negate(minimum(negate(x), negate(y))); }

Range floor_of(const Range& x_given) {
  const Range x = used(x_given);
  if (x.open) return open(floored(x.exact), x.why);
  return {.exact = floored(x.exact), .low = floored(x.low), .high = floored(x.high)};
}

Range truncate(const Range& x_given) {
  const Range x = used(x_given);
  if (x.open) return open(truncated(x.exact), x.why);
  return {.exact = truncated(x.exact), .low = truncated(x.low), .high = truncated(x.high)};
}

Range divide(const Rules& rules, const Range& x_given, const Range& y_given) {
  const Range x = used(x_given), y = used(y_given);
  const Real exact = x.exact / y.exact;
  if (x.open || y.open) return first_open(x, y, exact);
  // The table's bound holds for |y| in [2^-126, 2^126], of 16 bits in [2^-14, 2^14].
  const Real smallest = smallest_normal(rules.format), largest = 1 / smallest;
  const bool bounded = (y.low >= smallest && y.high <= largest) || (y.high <= -smallest && y.low >= -largest);
  if (!bounded) return open(exact, "quotients have no bound where the divisor is very small or very large");
  Range result = of_corners(x, y, [](Real a, Real b) { return a / b; });
  result.exact = exact;
  if (!are_numbers(result)) return open(exact, no_number);
  const Real error = 2.5 * std::max(ulp(result.low, rules.format), ulp(result.high, rules.format));
  return within(rules, result, error);
}

Range inverse_sqrt(const Rules& rules, const Range& x_given) {
  const Range x = used(x_given);
  const Real exact = 1 / square_root(x.exact);
  if (x.open) return open(exact, x.why);
  if (x.low < 0) return open(exact, "the root of a negative number is open");
  const Real low = 1 / square_root(x.high), high = 1 / square_root(x.low);
  Range result{.exact = exact, .low = low - 2 * ulp(low, rules.format), .high = high};
  if (is_finite(high)) result.high += 2 * ulp(high, rules.format);
  mark_flush(rules, result);
  return result;
}

Range square_root(const Rules& rules, const Range& x_given) {
  const Range x = used(x_given);
  const Real exact = square_root(x.exact);
  if (x.open) return open(exact, x.why);
  if (x.low < 0) return open(exact, "the root of a negative number is open");
  // Inherited from 1.0 / inversesqrt(). Zero and infinity stay what they are: taken literally, 1 / 0 and 1 / infinity
  // have no bound.
  const auto bound = [&](Real value, Real direction) -> Real {
    if (value == 0 || is_infinite(value)) return value;
    const Real inverse = 1 / square_root(value);
    const Real root = 1 / (inverse - direction * 2 * ulp(inverse, rules.format));
    return root + direction * 2.5 * ulp(root, rules.format);
  };
  Range result{.exact = exact, .low = bound(x.low, -1), .high = bound(x.high, 1)};
  mark_flush(rules, result);
  return inherited(result);
}

Range dot(const Rules& rules, std::span<const Range> x, std::span<const Range> y) {
  Range sum;
  Real magnitude = 0;
  bool exact = true;
  int last_digit = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Range product = multiply(rules, x[i], y[i]);
    if (product.open) return open(product.exact, product.why);
    const Range bounds = used(product);
    sum.tail += sum_tail(sum.exact, product.exact);
    sum.exact += product.exact;
    sum.low += bounds.low;
    sum.high += bounds.high;
    magnitude += std::max(absolute(bounds.low), absolute(bounds.high));
    exact = exact && bounds.low == bounds.high;
    if (exact && bounds.low != 0 && is_finite(bounds.low)) last_digit = std::min(last_digit, last_digit_of(bounds.low));
  }
  if (!are_numbers(sum)) return open(sum.exact, no_number);
  if (x.size() == 1) return rounded(rules, sum, 0, 0);
  // In every order the partial sums are at most the sum of magnitudes. Each of the additions rounds once, unless the
  // products' digits all fit into one number.
  Real error = 0;
  const bool fits = exact && is_finite(magnitude) &&
                    (magnitude == 0 || exponent_of(magnitude) - last_digit <= rules.format.mantissa_bits);
  for (std::size_t i = 1; i < x.size() && !fits; ++i) error += ulp(magnitude + error, rules.format);
  if (magnitude + error > largest_finite(rules.format)) return open(sum.exact, "a partial sum may overflow");
  return within(rules, sum, error);
}

bool permits(const Rules& rules, const Range& range, Real value) {
  if (range.open) return true;
  if (is_nan(value)) return is_nan(range.exact);
  if (is_nan(range.exact)) return false;
  const Real largest = largest_finite(rules.format);
  if (is_infinite(value)) return value > 0 ? range.high > largest : range.low < -largest;
  if (value == 0 && range.may_be_zero) return true;
  if (rules.must_flush && is_denormal(value, rules.format)) return false;
  if (rules.quantized && rounded_down(value, rules.format) != value) return false;
  // Beyond the largest number, an infinity or that number is returned.
  const Real low = std::min(range.low, largest), high = std::max(range.high, -largest);
  return value >= low && value <= high;
}

}  // namespace tandem::program
