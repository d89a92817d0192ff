#include <algorithm>

#include "program/cause/permitted.hpp"

/// Integers with more bits than the operands: carries, high halves, dot products.
namespace tandem::program {
namespace {

__extension__ typedef unsigned __int128 Wide;
__extension__ typedef __int128 SignedWide;

/// The two members of the result, each as wide as the operands.
std::optional<std::pair<std::uint64_t, std::uint64_t>> halves(spv::Op op, const Scalar& x, const Scalar& y) {
  const std::uint64_t mask = mask_of(x.width);
  const auto split = [&](Wide value) {
    return std::pair(static_cast<std::uint64_t>(value) & mask, static_cast<std::uint64_t>(value >> x.width) & mask);
  };
  switch (op) {
    case spv::OpIAddCarry:
      return split(static_cast<Wide>(x.bits) + y.bits);
    case spv::OpISubBorrow:
      return std::pair((x.bits - y.bits) & mask, std::uint64_t{x.bits < y.bits});
    case spv::OpUMulExtended:
      return split(static_cast<Wide>(x.bits) * y.bits);
    case spv::OpSMulExtended:
      return split(static_cast<Wide>(static_cast<SignedWide>(signed_of(x)) * signed_of(y)));
    default:
      return std::nullopt;
  }
}

struct DotForm {
  bool first_signed = false, second_signed = false, saturates = false;
};

/// SPV_KHR_integer_dot_product.
std::optional<DotForm> dot_form(spv::Op op) {
  switch (op) {
    case spv::OpSDotKHR:
      return DotForm{true, true, false};
    case spv::OpUDotKHR:
      return DotForm{false, false, false};
    case spv::OpSUDotKHR:
      return DotForm{true, false, false};
    case spv::OpSDotAccSatKHR:
      return DotForm{true, true, true};
    case spv::OpUDotAccSatKHR:
      return DotForm{false, false, true};
    case spv::OpSUDotAccSatKHR:
      return DotForm{true, false, true};
    default:
      return std::nullopt;
  }
}

/// The components; of a scalar, PackedVectorFormat4x8Bit is the only format.
Scalars unpacked(const Scalars& operand) {
  if (operand.size() > 1) return operand;
  Scalars bytes;
  for (unsigned shift = 0; shift < 32; shift += 8)
    bytes.push_back({operand[0].kind, 8, operand[0].bits >> shift & 0xff, operand[0].undefined});
  return bytes;
}

Permitted integer_dot(const Call& call, const DotForm& form) {
  const Scalars x = unpacked(call.operand(0)), y = unpacked(call.operand(1));
  Scalar result = call.result_scalar(0);
  const auto value = [](const Scalar& scalar, bool is_signed) {
    return is_signed ? static_cast<SignedWide>(signed_of(scalar)) : static_cast<SignedWide>(scalar.bits);
  };
  const SignedWide largest = static_cast<SignedWide>(mask_of(result.width - (form.first_signed ? 1 : 0)));
  const SignedWide smallest = form.first_signed ? -largest - 1 : 0;
  SignedWide sum = 0;
  bool overflows = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    result.undefined |= x[i].undefined || y[i].undefined;
    const SignedWide product = value(x[i], form.first_signed) * value(y[i], form.second_signed);
    sum += product;
    overflows |= product > largest || product < smallest || sum > largest || sum < smallest;
  }
  if (form.saturates) {
    if (overflows) return undefined(result, "a sum overflows in front of the accumulator");
    const Scalar& accumulator = call.operand(2)[0];
    result.undefined |= accumulator.undefined;
    sum = std::clamp(sum + value(accumulator, form.first_signed), smallest, largest);
  }
  result.bits = static_cast<std::uint64_t>(sum) & mask_of(result.width);
  return exactly_this(result);
}

}  // namespace

std::optional<Permissions> permitted_extended_integers(const Call& call) {
  const spv::Op op = call.instruction.op;
  if (const std::optional<DotForm> form = dot_form(op)) return Permissions{integer_dot(call, *form)};
  if (!halves(op, {}, {})) return std::nullopt;
  const std::size_t count = call.result.size() / 2;
  Permissions permissions(call.result.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Scalar &x = call.operand(0, i), &y = call.operand(1, i);
    const auto [low, high] = *halves(op, x, y);
    Scalar result = call.result_scalar(i);
    result.undefined = x.undefined || y.undefined;
    result.bits = low;
    permissions[i] = exactly_this(result);
    result.bits = high;
    permissions[count + i] = exactly_this(result);
  }
  return permissions;
}

}  // namespace tandem::program
