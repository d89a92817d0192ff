// Operators and functions. What each needs to stay inside of what is defined is in its text.

#include <fmt/format.h>

#include "tests/family/generator.hpp"

namespace tandem::family {

Expression Generator::make(const Type& type, const std::string& text, const std::vector<Type>& parts, int depth) {
  Expression result{type, text};
  for (const Type& part : parts) result.parts.push_back(expression(part, depth - 1));
  return result;
}

Expression Generator::boolean(const Type& type, int depth) {
  Type compared = {choices_.of({Scalar::i32, Scalar::u32, Scalar::f32}), type.rows};
  if (has_small_ && choices_.chance(30)) compared.scalar = choices_.of({Scalar::i64, Scalar::u16, Scalar::i8});
  if (type.rows > 1) {
    switch (choices_.below(4)) {
      case 0:
        return make(type, "not($0)", {type}, depth);
      case 1:
        return make(type, choices_.of({"equal($0, $1)", "notEqual($0, $1)"}), {type, type}, depth);
      default:
        return make(type,
                    choices_.of({"lessThan($0, $1)", "lessThanEqual($0, $1)", "greaterThan($0, $1)",
                                 "greaterThanEqual($0, $1)", "equal($0, $1)", "notEqual($0, $1)"}),
                    {compared, compared}, depth);
    }
  }
  switch (choices_.below(9)) {
    case 0:
      return make(type, "($0 && $1)", {type, type}, depth);
    case 1:
      return make(type, "($0 || $1)", {type, type}, depth);
    case 2:
      return make(type, choices_.of({"($0 ^^ $1)", "($0 == $1)", "($0 != $1)"}), {type, type}, depth);
    case 3:
      return make(type, "!$0", {type}, depth);
    case 4:
      return make(type, choices_.of({"any($0)", "all($0)"}), {{Scalar::boolean, choices_.between(2, 4)}}, depth);
    case 5:
      compared.rows = choices_.between(2, 4);
      return make(type, choices_.of({"($0 == $1)", "($0 != $1)"}), {compared, compared}, depth);
    default:
      return make(type, choices_.of({"($0 < $1)", "($0 <= $1)", "($0 > $1)", "($0 >= $1)", "($0 == $1)", "($0 != $1)"}),
                  {compared, compared}, depth);
  }
}

Expression Generator::integer(const Type& type, int depth) {
  const std::string name = name_of(type);
  Type scalar = type;
  scalar.rows = 1;
  const std::string one = name_of(scalar);
  const bool is_unsigned = type.scalar == Scalar::u32 || type.scalar == Scalar::u64 || type.scalar == Scalar::u16 ||
                           type.scalar == Scalar::u8;
  const bool has_32_bits = type.scalar == Scalar::i32 || type.scalar == Scalar::u32;
  Type other = type;
  switch (choices_.below(has_32_bits ? 20 : 13)) {
    case 0:
    case 1:
      return make(type, "($0 + $1)", {type, type}, depth);
    case 2:
      return make(type, "($0 - $1)", {type, type}, depth);
    case 3:
      return make(type, "($0 * $1)", {type, type}, depth);
    case 4:
      // Neither by zero nor the least number by -1.
      return make(type, fmt::format("($0 / (($1 & {0}(15)) + {0}(1)))", one), {type, type}, depth);
    case 5:
      if (!is_unsigned)
        return make(type, fmt::format("(($0 & {0}(127)) % (($1 & {0}(15)) + {0}(1)))", one), {type, type}, depth);
      return make(type, fmt::format("($0 % (($1 & {0}(15)) + {0}(1)))", one), {type, type}, depth);
    case 6:
      return make(type, choices_.of({"($0 & $1)", "($0 | $1)", "($0 ^ $1)"}), {type, type}, depth);
    case 7:
      return make(type, choices_.of({"(~$0)", "(-$0)"}), {type}, depth);
    case 8:
      return make(type, fmt::format("($0 {} ($1 & {}(7)))", choices_.of({"<<", ">>"}), one), {type, type}, depth);
    case 9:
      return make(type, choices_.of({"min($0, $1)", "max($0, $1)"}), {type, type}, depth);
    case 10:
      return make(type, fmt::format("clamp($0, {0}(3), {0}(90))", name), {type}, depth);
    case 11: {
      if (type.rows > 1 && !has_32_bits) return make(type, "($0 + $1)", {type, scalar}, depth);
      other.scalar = choices_.of({Scalar::i32, Scalar::u32});
      if (has_small_)
        other.scalar =
            choices_.of({Scalar::i64, Scalar::u64, Scalar::i16, Scalar::u16, Scalar::i8, Scalar::u8, Scalar::i32});
      return make(type, name + "($0)", {other}, depth);
    }
    case 12: {
      if (!has_32_bits) return make(type, "($0 * $1)", {type, type}, depth);
      other.scalar = Scalar::f32;
      return make(type, fmt::format("{}(clamp($0, {:.1f}, 100000.0))", name, is_unsigned ? 0.0 : -100000.0), {other},
                  depth);
    }
    case 13:
      other.scalar = Scalar::boolean;
      return make(type, name + "($0)", {other}, depth);
    case 14:
      return is_unsigned ? make(type, "bitfieldReverse($0)", {type}, depth)
                         : make(type, choices_.of({"bitCount($0)", "findLSB($0)", "findMSB($0)"}), {type}, depth);
    case 15:
      return make(type, "bitfieldExtract($0, int($1 & 15u), int($2 & 15u))", {type, {Scalar::u32}, {Scalar::u32}},
                  depth);
    case 16:
      return make(type, "bitfieldInsert($0, $1, int($2 & 15u), int($3 & 15u))",
                  {type, type, {Scalar::u32}, {Scalar::u32}}, depth);
    case 17:
      if (is_unsigned) return make(type, "(($0 + $1) * $1)", {type, type}, depth);
      return make(type, choices_.of({"abs($0 >> 1)", "sign($0)"}), {type}, depth);
    case 18:
      other.scalar = Scalar::f32;
      return make(type, (is_unsigned ? "(floatBitsToUint($0) & 0x7fffffffu)" : "(floatBitsToInt($0) & 0x7fffffff)"),
                  {other}, depth);
    default:
      return make(type, fmt::format("($0 {} $1)", choices_.of({"+", "-", "*", "^"})), {type, scalar}, depth);
  }
}

Expression Generator::real(const Type& type, int depth) {
  Type scalar = {Scalar::f32}, other = type;
  switch (choices_.below(features_.approximate ? 26 : 18)) {
    case 0:
    case 1:
      return make(type, "($0 + $1)", {type, type}, depth);
    case 2:
      return make(type, "($0 - $1)", {type, type}, depth);
    case 3:
    case 4:
      return make(type, "($0 * $1)", {type, type}, depth);
    case 5:
      return make(type, "($0 * $1)", {type, scalar}, depth);
    case 6:
      return make(type, "($0 / (abs($1) + 1.0))", {type, type}, depth);
    case 7:
      return make(type, choices_.of({"min($0, $1)", "max($0, $1)"}), {type, type}, depth);
    case 8:
      return make(type, choices_.of({"clamp($0, -7.5, 90.0)", "max(min($0, 30.0), -2.0)"}), {type}, depth);
    case 9:
      return make(type, choices_.of({"floor($0)", "ceil($0)", "trunc($0)", "roundEven($0)"}), {type}, depth);
    case 10:
      return make(type, choices_.of({"abs($0)", "sign($0)", "(-$0)"}), {type}, depth);
    case 11:
      return make(type, "step($0, $1)", {type, type}, depth);
    case 12:
      return make(type, "sqrt(abs($0))", {type}, depth);
    case 13:
      other.scalar = choices_.of({Scalar::i32, Scalar::u32});
      return make(type, fmt::format("{}($0 & {})", name_of(type), other.scalar == Scalar::i32 ? "1023" : "1023u"),
                  {other}, depth);
    case 14:
      other.scalar = Scalar::boolean;
      return make(type, name_of(type) + "($0)", {other}, depth);
    case 15:
      other.scalar = Scalar::boolean;
      return make(type, "mix($0, $1, $2)", {type, type, other}, depth);
    case 16:
      if (has_small_ && type.rows == 1)
        return make(type, "float(int($0) & 255)", {{choices_.of({Scalar::i64, Scalar::i16, Scalar::u8})}}, depth);
      return make(type, "($0 - floor($0))", {type}, depth);
    case 17:
      return make(type, "floor($0 * 0.25)", {type}, depth);
    case 18:
      if (type.rows > 1) return make(type, "normalize($0 + $1)", {type, type}, 1);
      return make(type, "length($0)", {{Scalar::f32, choices_.between(2, 4)}}, 1);
    case 19: {
      const Type vector = {Scalar::f32, choices_.between(2, 4)};
      if (type.rows > 1) return make(type, "($0 * dot($1, $2))", {type, type, type}, 1);
      return make(type, choices_.of({"dot($0, $1)", "distance($0, $1)"}), {vector, vector}, 1);
    }
    case 20:
      if (type.rows == 3) return make(type, "cross($0, $1)", {type, type}, depth);
      return make(type, "mix($0, $1, 0.25)", {type, type}, depth);
    case 21:
      return make(type, "mix($0, $1, $2)", {type, type, type}, 1);
    case 22:
      return make(type, "inversesqrt(abs($0) + 1.0)", {type}, depth);
    case 23:
      return make(type, "mod($0, abs($1) + 1.0)", {type, type}, 1);
    case 24:
      return make(type, "smoothstep(0.0, 4.0, $0)", {type}, depth);
    default:
      if (type.rows > 1)
        return make(type, choices_.of({"reflect($0, $1)", "faceforward($0, $1, $2)"}), {type, type, type}, 1);
      return make(type, "fract($0)", {type}, depth);
  }
}

Expression Generator::matrix(const Type& type, int depth) {
  Type turned = type, left = type, right = type;
  turned.rows = type.columns;
  turned.columns = type.rows;
  const Type row = {Scalar::f32, type.columns}, column = {Scalar::f32, type.rows};
  left.columns = right.rows = choices_.between(2, 4);
  switch (choices_.below(features_.approximate ? 8 : 6)) {
    case 0:
      return make(type, choices_.of({"($0 + $1)", "($0 - $1)"}), {type, type}, depth);
    case 1:
      return make(type, "($0 * $1)", {type, {Scalar::f32}}, depth);
    case 2:
      return make(type, "transpose($0)", {turned}, depth);
    case 3:
      return make(type, "matrixCompMult($0, $1)", {type, type}, depth);
    case 4:
      return constructed(type, depth);
    case 5:
      return make(type, "outerProduct($0, $1)", {column, row}, depth);
    default:
      return make(type, "($0 * $1)", {left, right}, depth);
  }
}

}  // namespace tandem::family
