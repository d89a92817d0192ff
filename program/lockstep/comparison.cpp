#include "program/lockstep/comparison.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "program/lockstep/walk.hpp"

namespace tandem::program {
namespace {

using SiteKey = std::pair<const RecordedShader*, std::size_t>;

std::vector<std::optional<RecordedWords>> operands_of(const Walk& walk, const Instruction& instruction) {
  std::vector<std::optional<RecordedWords>> operands;
  for (const std::uint16_t used : instruction.used_ids) operands.push_back(walk.value_of(instruction.words[used]));
  return operands;
}

RecordedWords words_at(const SlotView& slot, std::size_t position, const std::vector<Component>& components) {
  const auto words = slot.words.subspan(position, word_count(components));
  return {components, {words.begin(), words.end()}};
}

/// Calls visit(instruction, value) for each instruction of the segment; `value` is null where it records none.
template <typename Visit>
void for_each_instruction(const Segment& segment, const Visit& visit) {
  auto value = segment.values.begin();
  for (std::size_t i = segment.first_instruction; i < segment.end_instruction; ++i) {
    const bool is_recorded = value != segment.values.end() && value->instruction == i;
    visit(i, is_recorded ? &*value : nullptr);
    if (is_recorded) ++value;
  }
}

Difference difference_at(const Walk& walk, std::size_t i, std::size_t slot, std::size_t position, std::size_t order,
                         RecordedWords a, RecordedWords b) {
  const Instruction& instruction = walk.shader().module.instructions[i];
  Difference difference{.shader = &walk.shader(),
                        .instruction = i,
                        .slot = slot,
                        .position = position,
                        .order = order,
                        .operands = operands_of(walk, instruction),
                        .a = std::move(a),
                        .b = std::move(b),
                        .judgement = {}};
  difference.judgement = judge(walk.shader().module, instruction, difference.operands, difference.a, difference.b);
  return difference;
}

/// The id that the last instruction of the segment decides by; 0 where it has none.
std::uint32_t decision_of(const RecordedShader& shader, const Segment& segment) {
  const Instruction& last = shader.module.instructions[segment.end_instruction - 1];
  return last.op == spv::OpBranchConditional || last.op == spv::OpSwitch ? last.words[1] : 0;
}

}  // namespace

int gravity(Cause cause) {
  switch (cause) {
    case Cause::equal:
      return 0;
    case Cause::within_precision:
      return 1;
    case Cause::device_defined:
      return 2;
    case Cause::tie:
      return 3;
    case Cause::order:
      return 4;
    case Cause::undefined:
      return 5;
    case Cause::mismatch:
      return 6;
  }
  return 6;
}

LockstepComparison compare_lockstep(const RecordedLaunch& launch, const Recording& a, const Recording& b) {
  LockstepComparison result;
  std::map<SiteKey, std::uint64_t> executions;
  std::map<SiteKey, Site> sites;
  for (std::size_t slot = 0; slot < a.request.invocations.size(); ++slot) {
    const SlotView slot_a = slot_of(a.request, a.buffer, slot), slot_b = slot_of(b.request, b.buffer, slot);
    if (!slot_a.complete) ++result.incomplete;
    Walk walk(launch, slot_a);
    std::size_t order = 0;
    bool parted = false;
    while (walk.next()) {
      // A shader that only a has called: the values of b are those of another one.
      const bool same = walk.position() < slot_b.words.size() && slot_b.words[walk.position()] == walk.number() &&
                        walk.position() + walk.segment().words <= slot_b.words.size();
      parted = parted || !same;
      for_each_instruction(walk.segment(), [&](std::size_t i, const RecordedValue* value) {
        if (value != nullptr) {
          const SiteKey key{&walk.shader(), i};
          ++executions[key];
          RecordedWords words_a = walk.words_of(*value);
          RecordedWords words_b = same ? words_at(slot_b, walk.position() + value->offset, value->components) : words_a;
          if (words_a.words != words_b.words) {
            Difference difference = difference_at(walk, i, slot, walk.position() + value->offset, order,
                                                  std::move(words_a), std::move(words_b));
            const Cause cause = difference.judgement.cause;
            auto [site, is_new] = sites.try_emplace(key, Site{.shader = key.first, .instruction = i, .example = {}});
            ++site->second.differences;
            ++site->second.causes[static_cast<std::size_t>(cause)];
            if (is_new || gravity(cause) > gravity(site->second.example.judgement.cause))
              site->second.example = std::move(difference);
          }
          ++order;
          if (same) ++result.values;
        }
        walk.pass(i);
      });
    }
    result.parted += parted ? 1 : 0;
  }
  for (auto& [key, site] : sites) {
    site.executions = executions[key];
    result.sites.push_back(std::move(site));
  }
  std::ranges::stable_sort(result.sites, std::greater<>(),
                           [](const Site& site) { return gravity(site.example.judgement.cause); });
  return result;
}

FirstDifference first_difference(const RecordedLaunch& launch, const Recording& a, const Recording& b,
                                 std::size_t slot) {
  const SlotView slot_a = slot_of(a.request, a.buffer, slot), slot_b = slot_of(b.request, b.buffer, slot);
  Walk walk(launch, slot_a), other(launch, slot_b);
  FirstDifference first;
  std::size_t order = 0;
  while (!first.decision && walk.next() && other.next()) {
    if (walk.number() != other.number()) break;  // another shader: its call has differed
    for_each_instruction(walk.segment(), [&](std::size_t i, const RecordedValue* value) {
      if (value != nullptr) {
        RecordedWords words_a = walk.words_of(*value), words_b = other.words_of(*value);
        if (words_a.words != words_b.words && !first.value)
          first.value = difference_at(walk, i, slot, walk.position() + value->offset, order, std::move(words_a),
                                      std::move(words_b));
        ++order;
      }
      walk.pass(i);
      other.pass(i);
    });
    const std::uint32_t decision = decision_of(walk.shader(), walk.segment());
    std::optional<RecordedWords> words_a = walk.value_of(decision), words_b = other.value_of(decision);
    if (words_a && words_b && words_a->words != words_b->words)
      first.decision = difference_at(walk, walk.shader().module.definitions.at(decision), slot, walk.position(), order,
                                     std::move(*words_a), std::move(*words_b));
  }
  return first;
}

}  // namespace tandem::program
