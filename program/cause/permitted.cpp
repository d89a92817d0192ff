#include "program/cause/permitted.hpp"

#include <algorithm>

namespace tandem::program {
namespace {

constexpr const char* specials = "NaN and infinity need only be kept with SignedZeroInfNanPreserve";

bool any_undefined(std::span<const Scalar> operands) {
  return std::any_of(operands.begin(), operands.end(), [](const Scalar& each) { return each.undefined; });
}

bool is_denormal(const Scalar& scalar) { return program::is_denormal(real_of(scalar), format_of(scalar.width)); }

/// SPIR-V, 2.14 "Relaxed Precision": magnitudes in [2^-14, 2^14].
bool is_beyond_relaxed(const Rules& rules, Real value) { return rules.relaxed && absolute(value) > 16384; }

}  // namespace

Permitted exactly_this(const Scalar& expected) {
  if (expected.undefined) return undefined(expected, undefined_operand);
  return {.expected = expected};
}

Permitted undefined(const Scalar& like, std::string reason) {
  return {.expected = like, .has_expected = false, .undefined = true, .reason = std::move(reason)};
}

Permitted moved_float(const Rules& rules, const Scalar& value) {
  if (value.undefined) return undefined(value, undefined_operand);
  const Real real = real_of(value);
  Permitted result{.expected = value, .ranges = {operand(rules, real)}, .rules = rules};
  if (rules.may_flush && is_denormal(value)) result.ranges[0].may_be_zero = true;
  result.open = is_beyond_relaxed(rules, real) || (!is_finite(real) && !rules.keeps_specials);
  if (result.open) result.reason = is_finite(real) ? "relaxed precision ends at 2^14" : specials;
  return result;
}

Permitted computed(const Rules& rules, std::uint32_t width, std::span<const Scalar> operands, const Formula& formula) {
  const Scalar like{ComponentKind::floating, width};
  if (any_undefined(operands)) return undefined(like, undefined_operand);
  const auto evaluate = [&](bool flush) {
    std::vector<Range> ranges;
    for (const Scalar& each : operands)
      ranges.push_back(flush && is_denormal(each) ? exactly(0) : operand(rules, real_of(each)));
    return formula(rules, ranges);
  };
  Permitted result{.rules = rules};
  const Range first = evaluate(false);
  const Format format = format_of(width);
  const Real rounded = rules.rounding == Rounding::to_zero ? rounded_to_zero(first.exact, format, first.tail)
                                                           : rounded_to_nearest(first.exact, format, first.tail);
  const bool flushes = rules.must_flush && program::is_denormal(rounded, format);
  result.expected = float_scalar(flushes ? Real{0} : rounded, width);
  result.ranges = {first};
  if (rules.may_flush && std::any_of(operands.begin(), operands.end(), [](const Scalar& s) { return is_denormal(s); }))
    result.ranges.push_back(evaluate(true));
  const bool finite =
      std::all_of(operands.begin(), operands.end(), [](const Scalar& each) { return is_finite(real_of(each)); });
  if (is_nan(rounded) && finite) return undefined(like, "the result is not a number");
  if (is_nan(rounded) && rules.keeps_specials) {
    result.ranges = {exactly(rounded)};
    return result;
  }
  if (!rules.keeps_specials && (!finite || !is_finite(rounded))) {
    result.open = true;
    result.reason = specials;
  } else if (is_beyond_relaxed(rules, first.exact) ||
             std::any_of(operands.begin(), operands.end(),
                         [&](const Scalar& each) { return is_beyond_relaxed(rules, real_of(each)); })) {
    result.open = true;
    result.reason = "relaxed precision ends at 2^14";
  } else if (const auto open = std::find_if(result.ranges.begin(), result.ranges.end(),
                                            [](const Range& range) { return range.open; });
             open != result.ranges.end()) {
    result.open = true;
    result.reason = open->why;
  }
  return result;
}

Permitted decided(const Rules& rules, const Scalar& like, std::span<const Scalar> operands,
                  const std::function<std::uint64_t(std::span<const Real>)>& decide) {
  if (any_undefined(operands)) return undefined(like, undefined_operand);
  std::vector<Real> reals;
  for (const Scalar& each : operands) reals.push_back(real_of(each));
  Permitted result = exactly_this({like.kind, like.width, decide(reals) & mask_of(like.width)});
  if (rules.may_flush) {
    for (std::size_t i = 0; i < reals.size(); ++i)
      if (is_denormal(operands[i])) reals[i] = 0;
    result.others.push_back(decide(reals) & mask_of(like.width));
    result.reason = "denormals may be flushed to zero";
  }
  return result;
}

}  // namespace tandem::program
