#include "program/cause/judge.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "program/cause/environment.hpp"
#include "program/cause/permitted.hpp"
#include "program/cause/verdict.hpp"

namespace tandem::program {
namespace {

constexpr std::string_view names[] = {"equal",     "within precision", "tie",     "order",
                                      "undefined", "device defined",   "mismatch"};

Judgement unknown(std::string reason) { return {.reason = std::move(reason)}; }

Scalars undefined_scalars(const Module& module, std::uint32_t type) {
  Scalars scalars;
  for (const Component& component : components_of(module, type).value_or(std::vector<Component>{}))
    scalars.push_back({component.kind, component.width, 0, true});
  return scalars;
}

/// Operands without a value that no evaluation asks for.
bool is_address(const Module& module, std::uint32_t id) {
  const std::uint32_t type = definition(module, id).type;
  return type != 0 && definition(module, type).op == spv::OpTypePointer;
}

Call call_of(const Module& module, const Instruction& instruction,
             std::span<const std::optional<RecordedWords>> operands, const RecordedWords& a,
             const ValueLookup& lookup) {
  Call call{.module = module,
            .instruction = instruction,
            .glsl = glsl_instruction(module, instruction),
            .ids = {},
            .operands = {},
            .result = a.components,
            .lookup = lookup};
  for (std::size_t i = 0; i < operands.size() && i < instruction.used_ids.size(); ++i) {
    if (instruction.op == spv::OpExtInst && i == 0) continue;  // the set
    const std::uint32_t id = instruction.words[instruction.used_ids[i]];
    const auto defined = module.definitions.find(id);
    call.ids.push_back(id);
    if (defined != module.definitions.end() && module.instructions[defined->second].op == spv::OpUndef)
      call.operands.push_back(undefined_scalars(module, module.instructions[defined->second].type));
    else
      call.operands.push_back(operands[i] ? std::optional(scalars_of(*operands[i])) : std::nullopt);
    if (call.operands.back() && call.operands.back()->empty()) call.operands.back().reset();
  }
  return call;
}

/// OpPhi takes the value of one predecessor: of which one, only the caller knows.
Judgement judge_phi(const Call& call, const Scalars& a, const Scalars& b) {
  bool a_found = false, b_found = false, all_known = true;
  const auto is_result = [](const Scalars& value, const Scalars& result) {
    return std::equal(value.begin(), value.end(), result.begin(), result.end(), are_alike);
  };
  for (std::size_t i = 0; i < call.operands.size(); i += 2) {  // each is followed by its label
    const std::optional<Scalars>& value = call.operands[i];
    if (value && !value->empty() && value->front().undefined)
      return {.cause = Cause::undefined, .wrong = WrongDevice::none, .reason = undefined_operand};
    all_known = all_known && value;
    if (value && is_result(*value, a) && is_result(*value, b))
      return {.cause = Cause::within_precision,
              .wrong = WrongDevice::none,
              .reason = "the sign of zero and the bits of a NaN are open"};
    a_found = a_found || (value && is_result(*value, a));
    b_found = b_found || (value && is_result(*value, b));
  }
  if (a_found && b_found) return unknown("the devices took the values of different predecessors");
  if (!all_known) return unknown("a predecessor's value is not recorded");
  Judgement judgement = unknown("the result is no predecessor's value");
  judgement.wrong = a_found ? WrongDevice::b : b_found ? WrongDevice::a : WrongDevice::both;
  return judgement;
}

std::optional<Permissions> permissions_of(const Call& call) {
  constexpr std::array families = {permitted_integers,      permitted_extended_integers, permitted_moves,
                                   permitted_conversions,   permitted_comparisons,       permitted_float_arithmetic,
                                   permitted_products,      permitted_glsl_common,       permitted_glsl_functions,
                                   permitted_glsl_geometry, permitted_glsl_matrices,     permitted_glsl_packing};
  for (const auto family : families)
    if (std::optional<Permissions> permissions = family(call)) return permissions;
  return std::nullopt;
}

/// A worse cause of any scalar is the cause of the whole.
int weight(Cause cause) {
  switch (cause) {
    case Cause::equal:
      return 0;
    case Cause::within_precision:
      return 1;
    case Cause::undefined:
      return 2;
    default:
      return 3;
  }
}

WrongDevice wrong_device(bool a, bool b) {
  if (a && b) return WrongDevice::both;
  return a ? WrongDevice::a : b ? WrongDevice::b : WrongDevice::none;
}

Judgement summary(const Call& call, const Permissions& permissions, const Scalars& a, const Scalars& b) {
  const std::string operation = operation_name(call.instruction, call.glsl);
  Judgement judgement{.cause = Cause::equal, .wrong = WrongDevice::none};
  bool a_wrong = false, b_wrong = false, has_expected = true;
  Scalars expected;
  for (std::size_t i = 0; i < permissions.size(); ++i) {
    has_expected = has_expected && permissions[i].has_expected;
    expected.push_back(permissions[i].expected);
    const Verdict verdict = verdict_of(permissions[i], operation, a[i], b[i]);
    a_wrong |= verdict.a_wrong;
    b_wrong |= verdict.b_wrong;
    if (weight(verdict.cause) <= weight(judgement.cause)) continue;
    judgement.cause = verdict.cause;
    judgement.error_a = verdict.error_a;
    judgement.error_b = verdict.error_b;
    judgement.allowed = verdict.allowed;
    judgement.reason = verdict.reason;
  }
  judgement.wrong = wrong_device(a_wrong, b_wrong);
  if (has_expected) judgement.expected = words_of(call.result, expected);
  return judgement;
}

}  // namespace

std::string_view name_of(Cause cause) {
  static_assert(std::size(names) == static_cast<std::size_t>(Cause::mismatch) + 1);
  return names[static_cast<std::size_t>(cause)];
}

Judgement judge(const Module& module, const Instruction& instruction,
                std::span<const std::optional<RecordedWords>> operands, const RecordedWords& a, const RecordedWords& b,
                const ValueLookup& lookup) {
  const Scalars of_a = scalars_of(a), of_b = scalars_of(b);
  const Call call = call_of(module, instruction, operands, a, lookup);
  if (instruction.op == spv::OpPhi) return judge_phi(call, of_a, of_b);
  for (std::size_t i = 0; i < call.operands.size(); ++i)
    if (!call.operands[i] && !is_address(module, call.ids[i])) return unknown("an operand is not recorded");
  const std::optional<Permissions> permissions = permissions_of(call);
  if (!permissions || permissions->size() != of_a.size() || of_b.size() != of_a.size())
    return unknown("the operands do not determine the result");
  return summary(call, *permissions, of_a, of_b);
}

}  // namespace tandem::program
