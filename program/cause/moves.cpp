#include <algorithm>

#include "program/cause/environment.hpp"
#include "program/cause/permitted.hpp"

/// Instructions that only move bits.
namespace tandem::program {
namespace {

/// Where the part of a composite that literals point to lies among its scalars: the first one, and how many.
std::pair<std::size_t, std::size_t> part_of(const Call& call, std::uint32_t type, std::span<const std::uint32_t> path) {
  const std::vector<Component> components = components_of(call.module, type).value_or(std::vector<Component>{});
  const auto is_inside = [&](const Component& component) {
    return component.path.size() >= path.size() && std::equal(path.begin(), path.end(), component.path.begin());
  };
  const auto first = std::find_if(components.begin(), components.end(), is_inside);
  return {static_cast<std::size_t>(first - components.begin()),
          static_cast<std::size_t>(std::count_if(first, components.end(), is_inside))};
}

Scalars extract(const Call& call) {
  const auto path = std::span(call.instruction.words).subspan(4);
  const auto [first, count] = part_of(call, definition(call.module, call.ids[0]).type, path);
  const Scalars& whole = call.operand(0);
  return {whole.begin() + static_cast<std::ptrdiff_t>(first),
          whole.begin() + static_cast<std::ptrdiff_t>(first + count)};
}

Scalars insert(const Call& call) {
  const auto path = std::span(call.instruction.words).subspan(5);
  const std::size_t first = part_of(call, call.instruction.type, path).first;
  Scalars whole = call.operand(1);
  std::copy(call.operand(0).begin(), call.operand(0).end(), whole.begin() + static_cast<std::ptrdiff_t>(first));
  return whole;
}

Scalars construct(const Call& call) {
  Scalars whole;
  for (std::size_t i = 0; i < call.operands.size(); ++i)
    whole.insert(whole.end(), call.operand(i).begin(), call.operand(i).end());
  return whole;
}

Scalars shuffle(const Call& call) {
  Scalars both = call.operand(0), result;
  both.insert(both.end(), call.operand(1).begin(), call.operand(1).end());
  for (const std::uint32_t index : std::span(call.instruction.words).subspan(5)) {
    result.push_back(index < both.size() ? both[index] : both[0]);
    result.back().undefined |= index >= both.size();  // 0xffffffff: no source
  }
  return result;
}

Scalars transpose(const Call& call) {
  const Instruction& type = definition(call.module, call.instruction.type);
  const std::size_t columns = type.words[3], rows = call.result.size() / columns;
  Scalars result;
  for (std::size_t column = 0; column < columns; ++column)
    for (std::size_t row = 0; row < rows; ++row) result.push_back(call.operand(0)[row * columns + column]);
  return result;
}

Scalars select(const Call& call) {
  Scalars result;
  for (std::size_t i = 0; i < call.result.size(); ++i) {
    const Scalar& condition = call.operand(0, i);
    result.push_back(call.operand(condition.bits != 0 ? 1 : 2)[i]);
    result.back().undefined |= condition.undefined;
  }
  return result;
}

constexpr const char* far_index = "the index is out of range";

Permitted moved(const Call& call, const Scalar& like, Scalar value) {
  value.kind = like.kind;
  value.width = like.width;
  if (like.kind != ComponentKind::floating) return exactly_this(value);
  return moved_float(rules_of(call.module, call.instruction, like.width), value);
}

Permissions dynamic(const Call& call) {
  const bool inserts = call.instruction.op == spv::OpVectorInsertDynamic;
  const Scalar& index = call.operand(inserts ? 2 : 1)[0];
  Permissions permissions;
  Scalars vector = call.operand(0);
  if (index.undefined || index.bits >= vector.size()) {
    for (std::size_t i = 0; i < call.result.size(); ++i)
      permissions.push_back(undefined(call.result_scalar(i), index.undefined ? undefined_operand : far_index));
    return permissions;
  }
  if (!inserts) return {moved(call, call.result_scalar(0), vector[index.bits])};
  vector[index.bits] = call.operand(1)[0];
  for (std::size_t i = 0; i < vector.size(); ++i) permissions.push_back(moved(call, call.result_scalar(i), vector[i]));
  return permissions;
}

/// The first components have the low-order bits (SPIR-V, OpBitcast).
Permissions bitcast(const Call& call) {
  std::vector<bool> bits;
  bool any_undefined = false, any_nan = false;
  for (const Scalar& each : call.operand(0)) {
    for (std::uint32_t i = 0; i < each.width; ++i) bits.push_back((each.bits >> i & 1) != 0);
    any_undefined |= each.undefined;
    any_nan |= each.kind == ComponentKind::floating && is_nan(real_of(each));
  }
  Permissions permissions;
  std::size_t next = 0;
  for (std::size_t i = 0; i < call.result.size(); ++i) {
    Scalar value = call.result_scalar(i);
    for (std::uint32_t bit = 0; bit < value.width && next < bits.size(); ++bit, ++next)
      value.bits |= std::uint64_t{bits[next]} << bit;
    value.undefined = any_undefined;
    permissions.push_back(moved(call, value, value));
    if (!any_nan) continue;
    permissions.back().open = true;
    permissions.back().reason = "the bits of a NaN are open";
  }
  return permissions;
}

std::optional<Scalars> plain_move(const Call& call) {
  switch (call.instruction.op) {
    case spv::OpCopyObject:
    case spv::OpCopyLogical:
      return call.operand(0);
    case spv::OpCompositeExtract:
      return extract(call);
    case spv::OpCompositeInsert:
      return insert(call);
    case spv::OpCompositeConstruct:
      return construct(call);
    case spv::OpVectorShuffle:
      return shuffle(call);
    case spv::OpTranspose:
      return transpose(call);
    case spv::OpSelect:
      return select(call);
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<Permissions> permitted_moves(const Call& call) {
  const spv::Op op = call.instruction.op;
  if (op == spv::OpVectorExtractDynamic || op == spv::OpVectorInsertDynamic) return dynamic(call);
  if (op == spv::OpBitcast) return bitcast(call);
  const std::optional<Scalars> values = plain_move(call);
  if (!values || values->size() != call.result.size()) return std::nullopt;
  Permissions permissions;
  for (std::size_t i = 0; i < values->size(); ++i)
    permissions.push_back(moved(call, call.result_scalar(i), (*values)[i]));
  return permissions;
}

}  // namespace tandem::program
