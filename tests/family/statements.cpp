#include <algorithm>

#include <fmt/format.h>

#include "tests/family/generator.hpp"

namespace tandem::family {

std::vector<Statement> Generator::block(Place place, int count) {
  std::vector<Statement> list;
  for (int i = 0; i < count && budget_ > 0; ++i) {
    --budget_;
    list.push_back(statement(place));
  }
  if ((place.may_break || place.may_return) && place.depth > 0 && choices_.chance(25)) list.push_back(jump(place));
  return list;
}

Statement Generator::statement(const Place& place) {
  const bool nests = place.depth < 5;
  const int kind = choices_.below(100);
  if (nests && kind < 18) return choice(place);
  if (nests && kind < 34 && place.loops < (current_ != nullptr ? 2 : 3)) return loop(place);
  if (nests && kind < 42) return selection(place);
  if (kind < 50 && calls_ < 3 && !functions_.empty()) return call();
  if (kind < 60) return store();
  if (kind < 66) return hashed();
  return assignment();
}

Statement Generator::assignment() {
  Expression place = lvalue();
  const Type type = place.type;
  const bool is_int = type.structure < 0 && !type.is_array() && is_integer(type.scalar);
  if (is_int && choices_.chance(25)) {
    if (choices_.chance(30)) return {choices_.of({"$0++;", "--$0;"}), {std::move(place)}};
    Expression value = expression(type, 2);
    return {choices_.of({"$0 += $1;", "$0 ^= $1;", "$0 -= $1;"}), {std::move(place), std::move(value)}};
  }
  Expression value = stored(type, choices_.between(1, 3));
  return {"$0 = $1;", {std::move(place), std::move(value)}};
}

/// A call with variables for its results, none of them twice.
Statement Generator::call() {
  const Signature& callee = choices_.of(functions_);
  Statement statement{callee.name + "("};
  std::vector<std::string> used;
  const auto variable_of = [&](const Type& type) -> const Variable* {
    std::vector<const Variable*> fitting;
    for (const Variable& each : variables_)
      if (each.type == type && each.is_writable && std::find(used.begin(), used.end(), each.name) == used.end())
        fitting.push_back(&each);
    if (fitting.empty()) return nullptr;
    const Variable* found = choices_.of(fitting);
    used.push_back(found->name);
    return found;
  };
  for (const Parameter& parameter : callee.parameters) {
    const std::string separator = statement.expressions.empty() ? "" : ", ";
    statement.text += fmt::format("{}${}", separator, statement.expressions.size());
    if (!parameter.is_out) {
      statement.expressions.push_back(stored(parameter.type, 1));
    } else if (const Variable* variable = variable_of(parameter.type)) {
      statement.expressions.push_back({parameter.type, variable->name});
    } else {
      return assignment();
    }
  }
  ++calls_;
  statement.text += ");";
  if (!callee.returns) return statement;
  if (const Variable* variable = variable_of(callee.result)) statement.text = variable->name + " = " + statement.text;
  return statement;
}

Statement Generator::choice(Place place) {
  ++place.depth;
  Expression condition = expression({Scalar::boolean}, 2);
  std::vector<std::vector<Statement>> blocks;
  blocks.push_back(block(place, choices_.between(1, 4)));
  if (choices_.chance(50)) return {"if ($0) @0", {std::move(condition)}, std::move(blocks)};
  blocks.push_back(block(place, choices_.between(1, 4)));
  return {"if ($0) @0 else @1", {std::move(condition)}, std::move(blocks)};
}

/// Below 8.
Expression Generator::trip_count() {
  switch (choices_.below(4)) {
    case 0:
      return {{Scalar::i32}, fmt::format("{}", choices_.between(1, 5))};
    case 1:
      return {{Scalar::i32}, "int(pc.n & 7u)"};
    default:
      return {{Scalar::i32}, "int($0 & 7u)", {expression({Scalar::u32}, 1)}};
  }
}

Statement Generator::loop(Place place) {
  ++place.depth;
  ++place.loops;
  place.may_break = true;
  const std::string i = fmt::format("i{}", names_++);
  const int kind = choices_.below(6);
  std::vector<Expression> parts;
  if (kind < 2)
    parts.push_back(trip_count());
  else
    parts.push_back(expression({Scalar::boolean}, 2));
  variables_.push_back({i, {Scalar::i32}, false});
  std::vector<std::vector<Statement>> blocks;
  blocks.push_back(block(place, choices_.between(1, 4)));
  std::string text;
  switch (kind) {
    case 0:
      text = fmt::format("for (int {0} = 0; {0} < $0; ++{0}) @0", i);
      break;
    case 1:
      text = fmt::format("for (int {0} = $0; {0} > 0; --{0}) @0", i);
      break;
    case 2:
      text = fmt::format("for (int {0} = 0; {0} < 6 && $0; ++{0}) @0", i);
      break;
    case 3:
      text = fmt::format("int {0} = 0; while ($0) {{ if ({0}++ >= {1}) break; @0 }}", i, choices_.between(2, 6));
      break;
    case 4:
      text = fmt::format("int {0} = 0; do @0 while (++{0} < {1} && $0);", i, choices_.between(2, 6));
      break;
    default:
      text = fmt::format("int {0} = 0; for (;;) {{ if (++{0} > {1} || $0) break; @0 }}", i, choices_.between(2, 6));
      break;
  }
  variables_.erase(std::find_if(variables_.begin(), variables_.end(), [&](const Variable& v) { return v.name == i; }));
  if (kind > 2) text = "{ " + text + " }";
  return {text, std::move(parts), std::move(blocks)};
}

Statement Generator::selection(Place place) {
  ++place.depth;
  Expression value;
  switch (choices_.below(3)) {
    case 0:
      value = {{Scalar::i32}, "($0 & 7) - 2", {expression({Scalar::i32}, 1)}};
      break;
    case 1:
      value = {{Scalar::u32}, "pc.m & 3u"};
      break;
    default:
      value = {{Scalar::u32}, "$0 & 7u", {expression({Scalar::u32}, 1)}};
      break;
  }
  const bool is_unsigned = value.type.scalar == Scalar::u32;
  const int cases = choices_.between(1, 4);
  const int default_at = choices_.below(cases + 2);  // after the last: none
  std::string text = "switch ($0) {";
  std::vector<std::vector<Statement>> blocks;
  int label = is_unsigned ? 0 : -2;
  for (int i = 0; i < cases; ++i) {
    if (i == default_at) text += " default:";
    do {
      text += fmt::format(" case {}{}:", label, is_unsigned ? "u" : "");
      label += choices_.between(1, 2);
    } while (choices_.chance(25));
    Place inside = place;
    inside.may_break = inside.may_break || choices_.chance(60);
    text += fmt::format(" @{}", blocks.size());
    blocks.push_back(block(inside, choices_.between(0, 3)));
    if (choices_.chance(60)) text += " break;";
  }
  if (default_at == cases) {
    text += fmt::format(" default: @{}", blocks.size());
    blocks.push_back(block(place, choices_.between(0, 2)));
  }
  return {text + " h ^= 3u; }", {std::move(value)}, std::move(blocks)};
}

Statement Generator::jump(const Place& place) {
  const int kind = choices_.below(10);
  if (place.may_return && (kind < 3 || !place.may_break)) {
    if (current_ != nullptr && current_->returns) return result_of_function();
    return {"return;"};
  }
  if (!place.may_break) return hashed();
  if (kind < 6 && place.loops > 0) return {"continue;"};
  return {"break;"};
}

Statement Generator::result_of_function() { return {"return $0;", {stored(current_->result, 2)}}; }

Statement Generator::store() {
  const auto real = [&] { return stored({Scalar::f32}, 2); };
  switch (choices_.below(8)) {
    case 0:
      return {"items[id].a[$0] = $1;", {index(5), real()}};
    case 1:
      return {"items[id].p = $0;", {stored({Scalar::f32, 3}, 2)}};
    case 2:
      return {"items[id].m[$0][$1] = $2;", {index(3), index(3), real()}};
    case 3:
      return {"items[id].b[$0] ^= $1;", {index(4), expression({Scalar::u32}, 2)}};
    case 4:
      if (has_small_) return {"items[id].s = $0;", {expression({Scalar::u16, 4}, 2)}};
      return {"items[id].q.y = $0;", {expression({Scalar::i32}, 2)}};
    case 5:
      return {"items[id].m[$0] = $1;", {index(3), stored({Scalar::f32, 3}, 2)}};
    default:
      return {fmt::format("own[id * {}u + $0] = $1;", own_words), {index(own_words), expression({Scalar::u32}, 2)}};
  }
}

/// Bits that no rounding hides, but for the sign, as devices need not keep that of zero.
Statement Generator::hashed() {
  switch (choices_.below(3)) {
    case 0:
      return {"h = h * 31u + (floatBitsToUint($0) & 0x7fffffffu);", {expression({Scalar::f32}, 2)}};
    case 1:
      return {"h = (h << 5) ^ (h >> 3) ^ $0;", {expression({Scalar::u32}, 2)}};
    default:
      return {"if ($0) h += 7u;", {expression({Scalar::boolean}, 2)}};
  }
}

/// What invocations tell each other, where all of them come.
Statement Generator::exchange() {
  const std::uint32_t size = size_[0] * size_[1] * size_[2];
  Expression value = expression({Scalar::u32}, 2);
  if (features_.barriers && (!features_.subgroups || choices_.chance(50)))
    return {fmt::format(
                "exchanged[gl_LocalInvocationIndex] = $0; barrier(); h += exchanged[(gl_LocalInvocationIndex + {}u) % "
                "{}u]; barrier();",
                choices_.below(9), size),
            {std::move(value)}};
  return {fmt::format("h += {};", choices_.of({"subgroupClusteredAdd($0, 4u)", "subgroupClusteredXor($0, 4u)",
                                               "subgroupClusteredMin($0, 4u)", "subgroupQuadSwapHorizontal($0)",
                                               "subgroupQuadBroadcast($0, 2u)", "subgroupShuffleXor($0, 3u)",
                                               "subgroupQuadSwapDiagonal($0)"})),
          {std::move(value)}};
}

}  // namespace tandem::family
