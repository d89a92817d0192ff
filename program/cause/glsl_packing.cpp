#include <algorithm>

#include <spirv_cross/GLSL.std.450.h>

#include "program/cause/environment.hpp"
#include "program/cause/permitted.hpp"

/// GLSL.std.450 from PackSnorm4x8 to UnpackDouble2x32. The formulas are those of the GLSL specification, 8.4
/// "Floating-Point Pack and Unpack Functions"; Vulkan's table does not name them.
namespace tandem::program {
namespace {

struct Packing {
  std::uint32_t bits = 8;  ///< of a field
  bool is_signed = false;

  Real scale() const { return static_cast<Real>(mask_of(bits - (is_signed ? 1 : 0))); }
};

std::optional<Packing> packing_of(std::uint32_t op) {
  switch (op) {
    case GLSLstd450PackSnorm4x8:
    case GLSLstd450UnpackSnorm4x8:
      return Packing{8, true};
    case GLSLstd450PackUnorm4x8:
    case GLSLstd450UnpackUnorm4x8:
      return Packing{8, false};
    case GLSLstd450PackSnorm2x16:
    case GLSLstd450UnpackSnorm2x16:
      return Packing{16, true};
    case GLSLstd450PackUnorm2x16:
    case GLSLstd450UnpackUnorm2x16:
      return Packing{16, false};
    default:
      return std::nullopt;
  }
}

/// round(clamp(x, -1, 1) * scale): halves go either way, and so does what the multiplication rounds to one.
std::vector<std::uint64_t> fields_of(const Rules& rules, const Packing& packing, Real x) {
  const Range clamped = minimum(maximum(operand(rules, x), exactly(packing.is_signed ? -1 : 0)), exactly(1));
  const Range product = multiply(rules, clamped, exactly(packing.scale()));
  const Real first = -floored(-(product.low - 0.5)), last = floored(product.high + 0.5);
  std::vector<std::uint64_t> fields;
  for (Real field = first; field <= last; field += 1)
    fields.push_back(static_cast<std::uint64_t>(static_cast<std::int64_t>(field)) & mask_of(packing.bits));
  // The nearest one first: it is what is expected.
  const Real nearest = floored(clamped.exact * packing.scale() + 0.5);
  const auto expected = static_cast<std::uint64_t>(static_cast<std::int64_t>(nearest)) & mask_of(packing.bits);
  std::iter_swap(fields.begin(), std::find(fields.begin(), fields.end() - 1, expected));
  return fields;
}

/// The halves that x may become.
std::vector<std::uint64_t> halves_of(const Rules& rules, Real x) {
  const Format half = format_of(16);
  std::vector<Real> values = {rounded_to_nearest(x, half)};
  if (rules.rounding != Rounding::to_nearest) values.push_back(rounded_to_zero(x, half));
  if (rules.rounding == Rounding::to_zero) values.erase(values.begin());
  if (rules.rounding == Rounding::unspecified) {
    values.push_back(rounded_down(x, half));
    values.push_back(rounded_up(x, half));
  }
  const bool may_be_zero = rules.may_flush && absolute(x) < smallest_normal(half);
  if (may_be_zero || x == 0) values.insert(values.end(), {Real{0}, -Real{0}});
  std::vector<std::uint64_t> fields;
  for (const Real value : values) {
    const std::uint64_t bits = encoded(value, half);
    if (std::find(fields.begin(), fields.end(), bits) == fields.end()) fields.push_back(bits);
  }
  return fields;
}

/// All words that have one of its fields at each place; the first of each makes the first word.
Permitted packed(const Scalar& like, const std::vector<std::vector<std::uint64_t>>& fields, std::uint32_t bits) {
  std::vector<std::uint64_t> words = {0};
  std::size_t count = 1;
  for (const auto& each : fields) count *= each.size();
  for (std::size_t i = 0; i < fields.size(); ++i) {
    std::vector<std::uint64_t> longer;
    for (const std::uint64_t word : words)
      for (std::size_t k = 0; k < (count > 4096 ? 1 : fields[i].size()); ++k)
        longer.push_back(word | fields[i][k] << (i * bits));
    words = std::move(longer);
  }
  Permitted result = exactly_this({like.kind, like.width, words[0]});
  result.others.assign(words.begin() + 1, words.end());
  result.reason = "the rounding of the fields is open";
  result.open = count > 4096;  // only of relaxed precision
  return result;
}

Permitted pack(const Call& call, const Scalar& like) {
  const Scalars& x = call.operand(0);
  const bool halves = call.glsl == GLSLstd450PackHalf2x16;
  const Packing packing = halves ? Packing{16, false} : *packing_of(call.glsl);
  const Rules rules = rules_of(call.module, call.instruction, halves ? 16 : 32);
  std::vector<std::vector<std::uint64_t>> fields;
  bool finite = true;
  for (const Scalar& each : x) {
    if (each.undefined) return undefined(like, undefined_operand);
    const Real value = real_of(each);
    if (is_nan(value) && !halves) return undefined(like, "an operand is NaN");
    finite = finite && is_finite(value);
    fields.push_back(halves ? halves_of(rules, value) : fields_of(rules, packing, value));
  }
  Permitted result = packed(like, fields, packing.bits);
  if (finite) return result;
  result.open = true;
  result.reason = "NaN and infinity need not be respected";
  return result;
}

/// clamp(field / scale, -1, 1)
Permitted unpack_norm(const Call& call, const Packing& packing, std::size_t component) {
  const Scalar& word = call.operand(0)[0];
  const std::uint64_t bits = word.bits >> (component * packing.bits) & mask_of(packing.bits);
  const Real field = packing.is_signed ? static_cast<Real>(sign_extended(bits, packing.bits)) : static_cast<Real>(bits);
  return computed(rules_of(call.module, call.instruction, 32), 32, {}, [&](const Rules& rules, std::span<const Range>) {
    const Range quotient = divide(rules, exactly(field), exactly(packing.scale()));
    return inherited(minimum(maximum(quotient, exactly(-1)), exactly(1)));
  });
}

Permitted unpack_half(const Call& call, std::size_t component) {
  const Scalar half{ComponentKind::floating, 16, call.operand(0)[0].bits >> (16 * component) & 0xffff,
                    call.operand(0)[0].undefined};
  Rules rules = rules_of(call.module, call.instruction, 32);
  const Rules half_rules = rules_of(call.module, call.instruction, 16);
  rules.may_flush = half_rules.may_flush;
  return computed(rules, 32, {&half, 1}, [](const Rules& r, std::span<const Range> x) { return convert(r, x[0]); });
}

}  // namespace

std::optional<Permissions> permitted_glsl_packing(const Call& call) {
  if (call.glsl < GLSLstd450PackSnorm4x8 || call.glsl > GLSLstd450UnpackDouble2x32) return std::nullopt;
  Permissions permissions;
  for (std::size_t i = 0; i < call.result.size(); ++i) {
    const Scalar like = call.result_scalar(i);
    const Scalars& operand = call.operand(0);
    if (call.glsl == GLSLstd450PackDouble2x32) {
      const Scalar value{ComponentKind::floating, 64, operand[0].bits | operand[1].bits << 32,
                         operand[0].undefined || operand[1].undefined};
      permissions.push_back(moved_float(rules_of(call.module, call.instruction, 64), value));
    } else if (call.glsl == GLSLstd450UnpackDouble2x32) {
      permissions.push_back(
          exactly_this({like.kind, like.width, operand[0].bits >> (32 * i) & 0xffffffff, operand[0].undefined}));
    } else if (call.glsl <= GLSLstd450PackHalf2x16) {
      permissions.push_back(pack(call, like));
    } else if (operand[0].undefined) {
      permissions.push_back(undefined(like, undefined_operand));
    } else if (call.glsl == GLSLstd450UnpackHalf2x16) {
      permissions.push_back(unpack_half(call, i));
    } else {
      permissions.push_back(unpack_norm(call, *packing_of(call.glsl), i));
    }
  }
  return permissions;
}

}  // namespace tandem::program
