#include "program/cause/verdict.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace tandem::program {
namespace {

struct Acceptance {
  bool accepted = false;
  std::string why = {};  ///< of what is accepted for another reason than its distance
};

constexpr const char* flushed = "denormals may be flushed to zero";

Acceptance accept_float(const Permitted& permitted, const Scalar& device) {
  const Rules& rules = permitted.rules;
  const Real value = real_of(device), exact = permitted.ranges.front().exact;
  if (rules.keeps_specials && value == 0 && exact == 0 && permitted.has_expected &&
      is_negative(value) != is_negative(real_of(permitted.expected)))
    return {};
  for (std::size_t i = 0; i < permitted.ranges.size(); ++i) {
    const Range& range = permitted.ranges[i];
    if (!permits(rules, range, value)) continue;
    if (value == 0 && exact != 0 && range.may_be_zero) return {true, flushed};
    if (i == 0) return {true};
    return {true, *range.why != '\0' ? range.why : flushed};
  }
  return {};
}

Acceptance accept(const Permitted& permitted, const Scalar& device) {
  if (device.kind == ComponentKind::floating) return accept_float(permitted, device);
  if (device.bits == permitted.expected.bits) return {true};
  const auto found = std::find(permitted.others.begin(), permitted.others.end(), device.bits);
  return found != permitted.others.end() ? Acceptance{true, permitted.reason} : Acceptance{};
}

/// The distance in units in the last place of the exact value.
std::optional<double> distance(Real value, const Range& exact, std::uint32_t width) {
  const Format format = format_of(width);
  const Real from = exact.exact;
  if (!is_finite(from) || !is_finite(value)) return std::nullopt;
  const Real unit = ulp(std::min(absolute(from), largest_finite(format)), format);
  return static_cast<double>(absolute(value - from) / unit);
}

std::optional<double> allowed_distance(const Permitted& permitted, std::uint32_t width) {
  const Range& exact = permitted.ranges.front();
  std::optional<double> result;
  for (const Range& range : permitted.ranges)
    for (const Real bound : {range.low, range.high}) {
      const std::optional<double> each = distance(bound, exact, width);
      if (!each) return std::nullopt;
      result = std::max(result.value_or(0), *each);
    }
  return result;
}

std::string distance_reason(const std::string& operation, const Verdict& verdict, bool accepted) {
  if (!verdict.allowed) return operation + " has another value";
  if (*verdict.allowed == 0) return operation + " is exact";
  if (*verdict.allowed <= 1)
    return accepted ? operation + " may be rounded either way" : operation + " is correctly rounded";
  return fmt::format("{} may err by {:.3g} ulp", operation, *verdict.allowed);
}

void fill_errors(Verdict& verdict, const Permitted& permitted, const Scalar& a, const Scalar& b) {
  if (a.kind != ComponentKind::floating || permitted.ranges.empty()) return;
  verdict.error_a = distance(real_of(a), permitted.ranges.front(), a.width);
  verdict.error_b = distance(real_of(b), permitted.ranges.front(), b.width);
  if (!permitted.open) verdict.allowed = allowed_distance(permitted, a.width);
}

constexpr std::array<const char*, 82> glsl_names = {"the result",
                                                    "round",
                                                    "roundEven",
                                                    "trunc",
                                                    "abs",
                                                    "abs",
                                                    "sign",
                                                    "sign",
                                                    "floor",
                                                    "ceil",
                                                    "fract",
                                                    "radians",
                                                    "degrees",
                                                    "sin",
                                                    "cos",
                                                    "tan",
                                                    "asin",
                                                    "acos",
                                                    "atan",
                                                    "sinh",
                                                    "cosh",
                                                    "tanh",
                                                    "asinh",
                                                    "acosh",
                                                    "atanh",
                                                    "atan",
                                                    "pow",
                                                    "exp",
                                                    "log",
                                                    "exp2",
                                                    "log2",
                                                    "sqrt",
                                                    "inversesqrt",
                                                    "determinant",
                                                    "inverse",
                                                    "modf",
                                                    "modf",
                                                    "min",
                                                    "min",
                                                    "min",
                                                    "max",
                                                    "max",
                                                    "max",
                                                    "clamp",
                                                    "clamp",
                                                    "clamp",
                                                    "mix",
                                                    "mix",
                                                    "step",
                                                    "smoothstep",
                                                    "fma",
                                                    "frexp",
                                                    "frexp",
                                                    "ldexp",
                                                    "packSnorm4x8",
                                                    "packUnorm4x8",
                                                    "packSnorm2x16",
                                                    "packUnorm2x16",
                                                    "packHalf2x16",
                                                    "packDouble2x32",
                                                    "unpackSnorm2x16",
                                                    "unpackUnorm2x16",
                                                    "unpackHalf2x16",
                                                    "unpackSnorm4x8",
                                                    "unpackUnorm4x8",
                                                    "unpackDouble2x32",
                                                    "length",
                                                    "distance",
                                                    "cross",
                                                    "normalize",
                                                    "faceforward",
                                                    "reflect",
                                                    "refract",
                                                    "findLSB",
                                                    "findMSB",
                                                    "findMSB",
                                                    "interpolateAtCentroid",
                                                    "interpolateAtSample",
                                                    "interpolateAtOffset",
                                                    "min",
                                                    "max",
                                                    "clamp"};

}  // namespace

std::string operation_name(const Instruction& instruction, std::uint32_t glsl) {
  if (glsl != 0) return glsl < glsl_names.size() ? glsl_names[glsl] : glsl_names[0];
  switch (instruction.op) {
    case spv::OpFAdd:
      return "an addition";
    case spv::OpFSub:
      return "a subtraction";
    case spv::OpFMul:
    case spv::OpVectorTimesScalar:
    case spv::OpMatrixTimesScalar:
    case spv::OpOuterProduct:
      return "a multiplication";
    case spv::OpFDiv:
      return "a division";
    case spv::OpFRem:
      return "a remainder";
    case spv::OpFMod:
      return "mod";
    case spv::OpFNegate:
      return "a negation";
    case spv::OpDot:
      return "dot";
    case spv::OpMatrixTimesMatrix:
    case spv::OpMatrixTimesVector:
    case spv::OpVectorTimesMatrix:
      return "a product of matrices";
    case spv::OpFConvert:
    case spv::OpConvertSToF:
    case spv::OpConvertUToF:
    case spv::OpQuantizeToF16:
      return "a conversion";
    default:
      return "the result";
  }
}

bool are_alike(const Scalar& a, const Scalar& b) {
  if (a.bits == b.bits) return true;
  if (a.kind != ComponentKind::floating) return false;
  return real_of(a) == real_of(b) || (is_nan(real_of(a)) && is_nan(real_of(b)));
}

Verdict verdict_of(const Permitted& permitted, const std::string& operation, const Scalar& a, const Scalar& b) {
  Verdict verdict;
  if (a.bits == b.bits) return verdict;
  verdict.cause = Cause::within_precision;
  fill_errors(verdict, permitted, a, b);
  if (permitted.undefined || permitted.open) {
    if (permitted.undefined) verdict.cause = Cause::undefined;
    verdict.reason = permitted.reason;
    return verdict;
  }
  if (a.kind == ComponentKind::floating && is_nan(real_of(a)) && is_nan(real_of(b))) {
    verdict.reason = "the bits of a NaN are open";
    return verdict;
  }
  const Acceptance of_a = accept(permitted, a), of_b = accept(permitted, b);
  verdict.a_wrong = !of_a.accepted;
  verdict.b_wrong = !of_b.accepted;
  const bool accepted = of_a.accepted && of_b.accepted;
  if (!accepted) verdict.cause = Cause::mismatch;
  if (a.kind != ComponentKind::floating)
    verdict.reason = accepted ? permitted.reason : operation + " is exact";
  else if (accepted && real_of(a) == 0 && real_of(b) == 0)
    verdict.reason = "the sign of zero need only be kept with SignedZeroInfNanPreserve";
  else if (accepted && !(of_a.why.empty() && of_b.why.empty()))
    verdict.reason = of_a.why.empty() ? of_b.why : of_a.why;
  else
    verdict.reason = distance_reason(operation, verdict, accepted);
  return verdict;
}

}  // namespace tandem::program
