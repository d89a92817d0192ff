#include <algorithm>

#include <fmt/format.h>

#include "tests/family/generator.hpp"

namespace tandem::family {

bool Generator::holds(const Type& whole, const Type& part) const {
  if (whole == part) return true;
  if (whole.is_array()) return holds(whole.element(), part);
  if (whole.is_struct()) {
    const auto& members = structs_[static_cast<std::size_t>(whole.structure)].members;
    return std::any_of(members.begin(), members.end(), [&](const Type& each) { return holds(each, part); });
  }
  return (whole.is_matrix() || whole.is_vector()) && holds(whole.component(), part);
}

Expression Generator::index(int length) {
  if (choices_.chance(40)) return {{Scalar::u32}, fmt::format("{}u", choices_.below(length))};
  return {{Scalar::u32}, fmt::format("($0 % {}u)", length), {leaf({Scalar::u32})}};
}

Expression Generator::descend(Expression from, const Type& to) {
  while (from.type != to) {
    const Type whole = from.type;
    if (whole.is_struct()) {
      const auto& members = structs_[static_cast<std::size_t>(whole.structure)].members;
      std::vector<int> fitting;
      for (std::size_t i = 0; i < members.size(); ++i)
        if (holds(members[i], to)) fitting.push_back(static_cast<int>(i));
      const int member = choices_.of(fitting);
      from = {members[static_cast<std::size_t>(member)], fmt::format("$0.m{}", member), {std::move(from)}};
      continue;
    }
    const bool is_vector = whole.is_vector();
    const int length = whole.is_array() ? whole.length : is_vector ? whole.rows : whole.columns;
    const Type part = whole.is_array()    ? whole.element()
                      : whole.is_vector() ? whole.component()
                                          : [&] {
                                              Type column = whole;
                                              column.columns = 1;
                                              return column;
                                            }();
    if (is_vector && choices_.chance(50)) {
      from = {part, fmt::format("$0.{}", "xyzw"[choices_.below(length)]), {std::move(from)}};
    } else {
      Expression at = index(length);
      from = {part, "$0[$1]", {std::move(from), std::move(at)}};
    }
  }
  return from;
}

Expression Generator::literal(const Type& type) {
  if (type.scalar == Scalar::boolean && type.is_scalar()) return {type, choices_.chance(50) ? "true" : "false"};
  if (type.scalar == Scalar::f32 && type.is_scalar())
    return {type, fmt::format("({:.3f})", choices_.between(-40, 40) * 0.125)};
  if (type.is_scalar()) {
    const bool is_signed = type.scalar == Scalar::i32 || type.scalar == Scalar::i64 || type.scalar == Scalar::i16 ||
                           type.scalar == Scalar::i8;
    const int value = choices_.between(is_signed ? -9 : 0, 40);
    if (type.scalar == Scalar::i32) return {type, value < 0 ? fmt::format("({})", value) : fmt::format("{}", value)};
    if (type.scalar == Scalar::u32)
      return {type, fmt::format("{}u", choices_.chance(20) ? choices_.word() : static_cast<std::uint32_t>(value))};
    return {type, fmt::format("{}({})", name_of(type), value)};
  }
  Expression result{type, name_of(type) + "("};
  const auto add = [&](const Type& part) {
    result.text += fmt::format("{}${}", result.parts.empty() ? "" : ", ", result.parts.size());
    result.parts.push_back(literal(part));
  };
  if (type.is_array()) {
    for (int i = 0; i < type.length; ++i) add(type.element());
  } else if (type.is_struct()) {
    for (const Type& member : structs_[static_cast<std::size_t>(type.structure)].members) add(member);
  } else {
    Type scalar = type;
    scalar.rows = scalar.columns = 1;
    for (int i = 0; i < type.rows * type.columns; ++i) add(scalar);
  }
  result.text += ")";
  return result;
}

Expression Generator::leaf(const Type& type) {
  std::vector<const Variable*> fitting;
  for (const Variable& variable : variables_)
    if (holds(variable.type, type)) fitting.push_back(&variable);
  if (!fitting.empty() && choices_.chance(65)) {
    const Variable& variable = *choices_.of(fitting);
    const bool nests = variable.type.is_array() || variable.type.is_struct();
    // An index is a leaf too: arrays in indices of arrays must end.
    if (!nests || type != Type{Scalar::u32} || choices_.chance(50))
      return descend({variable.type, variable.name}, type);
  }
  return choices_.chance(60) ? read(type) : literal(type);
}

/// What all invocations of a workgroup have in common.
Expression Generator::uniform(const Type& type) {
  if (type == Type{Scalar::u32}) {
    const char* name =
        choices_.of({"pc.n", "pc.m", "uni.n", "uni.u[$0][$1]", "gl_WorkGroupID.x", "gl_NumWorkGroups.y"});
    if (std::string(name) != "uni.u[$0][$1]") return {type, name};
    Expression row = index(4), column = index(4);
    return {type, name, {std::move(row), std::move(column)}};
  }
  if (type == Type{Scalar::i32}) return {type, choices_.of({"pc.i", "uni.i.x", "int(gl_WorkGroupID.x)"})};
  if (type == Type{Scalar::f32}) return {type, choices_.of({"pc.f", "uni.f[1].x", "reals[5]", "uni.m[2].y"})};
  if (type == Type{Scalar::boolean}) return {type, choices_.of({"(pc.n > 50u)", "((pc.m & 4u) == 0u)", "(pc.i < 3)"})};
  if (type == Type{Scalar::f32, 4}) return {type, "pc.v"};
  if (type == Type{Scalar::u32, 4}) return {type, "uni.u[1]"};
  if (type == Type{Scalar::f32, 4, 4}) return {type, "uni.m"};
  return literal(type);
}

/// Of buffers, constants and built-ins.
Expression Generator::read(const Type& type) {
  if (choices_.chance(uniform_percent_)) return uniform(type);
  const auto counted = [&](const char* text, int length) { return Expression{type, text, {index(length)}}; };
  if (type == Type{Scalar::u32}) {
    switch (choices_.below(12)) {
      case 0:
        return {type, "pc.n"};
      case 1:
        return {type, "uni.n"};
      case 2:
        return counted("words[$0]", input_words);
      case 3:
        return {type, fmt::format("own[id * {}u + $0]", own_words), {index(own_words)}};
      case 4:
        return {type, "uni.u[$0][$1]", {index(4), index(4)}};
      case 5:
        return {type, choices_.of({"gl_WorkGroupID.x", "gl_WorkGroupID.y", "gl_NumWorkGroups.x",
                                   "gl_LocalInvocationID.y", "gl_GlobalInvocationID.x"})};
      case 6:
        return {type, "gl_LocalInvocationIndex"};
      case 7:
        return counted("items[id].b[$0]", 4);
      case 8:
        return {type, "h"};
      case 9:
        return {type, "pc.m"};
      default:
        return {type, "id"};
    }
  }
  if (type == Type{Scalar::i32}) {
    switch (choices_.below(5)) {
      case 0:
        return {type, "pc.i"};
      case 1:
        return {type, "uni.i.x"};
      case 2:
        return {type, "items[id].i"};
      case 3:
        return counted("items[id].q[$0]", 2);
      default:
        return counted("int(words[$0])", input_words);
    }
  }
  if (type == Type{Scalar::f32}) {
    switch (choices_.below(6)) {
      case 0:
        return {type, "pc.f"};
      case 1:
        return {type, "uni.f[$0][$1]", {index(4), index(4)}};
      case 2:
        return counted("items[id].a[$0]", 5);
      case 3:
        return {type, "items[id].m[$0][$1]", {index(3), index(3)}};
      default:
        return counted("reals[$0]", input_words);
    }
  }
  if (type == Type{Scalar::f32, 4}) return choices_.chance(50) ? Expression{type, "pc.v"} : counted("uni.f[$0]", 4);
  if (type == Type{Scalar::u32, 4}) return counted("uni.u[$0]", 4);
  if (type == Type{Scalar::f32, 3}) return {type, "items[id].p"};
  if (type == Type{Scalar::i32, 2}) return {type, "items[id].q"};
  if (type == Type{Scalar::f32, 4, 4}) return {type, "uni.m"};
  if (type == Type{Scalar::f32, 3, 3}) return {type, "items[id].m"};
  if (type == Type{Scalar::u16, 4} && has_small_) return {type, "items[id].s"};
  if (type == Type{Scalar::f32, 1, 1, 5}) return {type, "items[id].a"};
  if (type == Type{Scalar::boolean}) return {type, "(($0 & 1u) != 0u)", {read({Scalar::u32})}};
  return literal(type);
}

Expression Generator::constructed(const Type& type, int depth) {
  Expression result{type, name_of(type) + "("};
  const auto add = [&](const Type& part) {
    result.text += fmt::format("{}${}", result.parts.empty() ? "" : ", ", result.parts.size());
    result.parts.push_back(stored(part, depth - 1));
  };
  if (type.is_array()) {
    for (int i = 0; i < type.length; ++i) add(type.element());
  } else if (type.is_struct()) {
    for (const Type& member : structs_[static_cast<std::size_t>(type.structure)].members) add(member);
  } else if (type.is_matrix()) {
    Type column = type;
    column.columns = 1;
    for (int i = 0; i < type.columns; ++i) add(column);
  } else {
    for (int left = type.rows; left > 0;) {
      Type part = type;
      part.rows = choices_.between(1, std::min(left, 2));
      left -= part.rows;
      add(part);
    }
  }
  result.text += ")";
  return result;
}

Expression Generator::called(const Signature& callee, int depth) {
  Expression result{callee.result, callee.name + "("};
  for (const Parameter& parameter : callee.parameters) {
    result.text += fmt::format("{}${}", result.parts.empty() ? "" : ", ", result.parts.size());
    result.parts.push_back(stored(parameter.type, depth - 1));
  }
  result.text += ")";
  ++calls_;
  return result;
}

/// A value for a variable: floats are rounded to multiples of 1/64 and kept below 1000.
Expression Generator::stored(const Type& type, int depth) {
  Expression value = expression(type, depth);
  if (!is_float(type)) return value;
  if (type.is_matrix()) fixed_matrices_.emplace(type.columns, type.rows);
  return {type, "fix($0)", {std::move(value)}};
}

Expression Generator::expression(const Type& type, int depth) {
  if (depth <= 0) return leaf(type);
  if (calls_ < 2 && choices_.chance(12)) {
    for (const Signature& each : functions_)
      if (each.returns && !each.has_out && each.result == type) return called(each, depth);
  }
  if (type.is_array() || type.is_struct())
    return choices_.chance(60) ? leaf(type) : choices_.chance(30) ? literal(type) : constructed(type, depth);
  if (choices_.chance(20)) return leaf(type);
  if (choices_.chance(10)) return make(type, "($0 ? $1 : $2)", {{Scalar::boolean}, type, type}, depth);
  if (type.is_matrix()) return matrix(type, depth);
  if (type.rows > 1 && choices_.chance(15)) return constructed(type, depth);
  if (type.rows > 1 && choices_.chance(15)) {
    Type other = type;
    other.rows = choices_.between(2, 4);
    std::string swizzle = "$0.";
    for (int i = 0; i < type.rows; ++i) swizzle += "xyzw"[choices_.below(other.rows)];
    return make(type, swizzle, {other}, depth);
  }
  if (type.scalar == Scalar::boolean) return boolean(type, depth);
  return type.scalar == Scalar::f32 ? real(type, depth) : integer(type, depth);
}

Expression Generator::lvalue() {
  std::vector<const Variable*> writable;
  for (const Variable& variable : variables_)
    if (variable.is_writable) writable.push_back(&variable);
  const Variable& variable = *choices_.of(writable);
  Expression place{variable.type, variable.name};
  while (!place.type.is_scalar() && choices_.chance(60)) place = member(std::move(place));
  return place;
}

/// A member, an element, a column or a component.
Expression Generator::member(Expression from) {
  Type part = from.type;
  if (part.is_struct()) {
    const auto& members = structs_[static_cast<std::size_t>(part.structure)].members;
    const int number = choices_.below(static_cast<int>(members.size()));
    return {members[static_cast<std::size_t>(number)], fmt::format("$0.m{}", number), {std::move(from)}};
  }
  if (part.is_array())
    part = part.element();
  else if (part.is_matrix())
    part.columns = 1;
  else
    part.rows = 1;
  return descend(std::move(from), part);
}

Expression Generator::some_scalar(Expression from) {
  while (!from.type.is_scalar()) from = member(std::move(from));
  return from;
}

}  // namespace tandem::family
