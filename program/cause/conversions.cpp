#include "program/cause/environment.hpp"
#include "program/cause/permitted.hpp"

/// Conversions between numbers: "correctly rounded", and what integers cannot hold is undefined (SPIR-V, 3.42.11).
namespace tandem::program {
namespace {

Permitted float_to_integer(const Call& call, const Scalar& like, const Scalar& operand, bool to_signed) {
  const Real value = truncated(real_of(operand));
  const Real bound = scaled(1, static_cast<int>(like.width) - (to_signed ? 1 : 0));
  if (!(value < bound) || value < (to_signed ? -bound : Real{0}))
    return undefined(like, is_nan(value) ? "the float is NaN" : "the float is outside of the integers");
  const auto bits_of = [&](Real number) {
    const auto magnitude = static_cast<std::uint64_t>(absolute(number));
    return (number < 0 ? 0 - magnitude : magnitude) & mask_of(like.width);
  };
  Permitted result = exactly_this({like.kind, like.width, bits_of(value), operand.undefined});
  if (operand.width == 32 && is_decorated(call.module, call.instruction.result, spv::DecorationRelaxedPrecision)) {
    result.open = absolute(value) > 16384;
    if (!result.open)
      result.others = {bits_of(truncated(rounded_down(real_of(operand), format_of(16)))),
                       bits_of(truncated(rounded_up(real_of(operand), format_of(16))))};
    result.reason = "relaxed precision is 16 bits";
  }
  return result;
}

Permitted integer_to_float(const Call& call, const Scalar& like, const Scalar& operand, bool from_signed) {
  if (operand.undefined) return undefined(like, undefined_operand);
  const std::int64_t number = signed_of(operand);
  const Real value = from_signed ? static_cast<Real>(number) : static_cast<Real>(operand.bits);
  return computed(rules_of(call.module, call.instruction, like.width), like.width, {},
                  [&](const Rules& rules, std::span<const Range>) { return convert(rules, exactly(value)); });
}

/// OpQuantizeToF16: any rounding, and zero where a normal number of 16 bits is too large.
Range quantized(const Rules&, const Range& x) {
  const Format half = format_of(16);
  Range result;
  result.exact = rounded_to_nearest(x.exact, half);
  result.low = rounded_down(x.low, half);
  result.high = rounded_up(x.high, half);
  result.may_be_zero = result.low < smallest_normal(half) && result.high > -smallest_normal(half);
  if (is_denormal(result.exact, half)) result.exact = result.exact < 0 ? -Real{0} : Real{0};
  return result;
}

Permitted between_floats(const Call& call, const Scalar& like, const Scalar& operand) {
  Rules rules = rules_of(call.module, call.instruction, like.width);
  if (call.instruction.op == spv::OpQuantizeToF16) {
    rules.format = format_of(16);
    rules.quantized = true;
    return computed(rules, like.width, {&operand, 1},
                    [](const Rules& r, std::span<const Range> x) { return quantized(r, x[0]); });
  }
  return computed(rules, like.width, {&operand, 1},
                  [](const Rules& r, std::span<const Range> x) { return convert(r, x[0]); });
}

std::optional<Permitted> converted(const Call& call, const Scalar& like, const Scalar& operand) {
  const auto integer = [&](std::uint64_t bits) {
    return exactly_this({like.kind, like.width, bits & mask_of(like.width), operand.undefined});
  };
  switch (call.instruction.op) {
    case spv::OpConvertFToU:
      return float_to_integer(call, like, operand, false);
    case spv::OpConvertFToS:
      return float_to_integer(call, like, operand, true);
    case spv::OpConvertSToF:
      return integer_to_float(call, like, operand, true);
    case spv::OpConvertUToF:
      return integer_to_float(call, like, operand, false);
    case spv::OpUConvert:
      return integer(operand.bits);
    case spv::OpSConvert:
      return integer(static_cast<std::uint64_t>(signed_of(operand)));
    case spv::OpFConvert:
    case spv::OpQuantizeToF16:
      return between_floats(call, like, operand);
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<Permissions> permitted_conversions(const Call& call) {
  if (call.operands.size() != 1 || !call.operands[0]) return std::nullopt;
  Permissions permissions;
  for (std::size_t i = 0; i < call.result.size(); ++i) {
    std::optional<Permitted> permitted = converted(call, call.result_scalar(i), call.operand(0, i));
    if (!permitted) return std::nullopt;
    permissions.push_back(std::move(*permitted));
  }
  return permissions;
}

}  // namespace tandem::program
