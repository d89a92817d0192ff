#include "program/lockstep/comparison.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "program/cause/judge.hpp"
#include "program/lockstep/walk.hpp"
#include "program/record/contraction.hpp"

namespace tandem::program {
namespace {

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

struct Comparing {
  const Walk& walk;
  std::size_t slot;
  const Circumstances& circumstances;
  const bool& parted;

  Divergence difference(const RecordedValue& value, std::size_t order, RecordedWords a, RecordedWords b) const {
    return difference_of(value.instruction, walk.position() + value.offset, value.is_address, order, std::move(a),
                         std::move(b));
  }

  Divergence difference_of(std::size_t i, std::size_t position, bool is_address, std::size_t order, RecordedWords a,
                           RecordedWords b) const {
    const Module& module = walk.shader().module;
    Divergence difference{.shader = &walk.shader(),
                          .instruction = i,
                          .slot = slot,
                          .position = position,
                          .order = order,
                          .is_address = is_address,
                          .parted = parted,
                          .operands = operands_of(walk, module.instructions[i]),
                          .a = std::move(a),
                          .b = std::move(b),
                          .judgement = {}};
    difference.judgement = judged(difference, difference.a);
    if (std::optional<Judgement> combined = judge_combined(difference)) difference.judgement = std::move(*combined);
    difference.judgement = judge_by_circumstances(walk, difference, circumstances);
    return difference;
  }

  Judgement judged(const Divergence& difference, const RecordedWords& a) const {
    const Module& module = walk.shader().module;
    return judge(module, module.instructions[difference.instruction], difference.operands, a, difference.b,
                 [&](std::uint32_t id) { return walk.value_of(id); });
  }

  /// The judgement about what device a's instruction gives alone, where that is not what it has recorded.
  std::optional<Judgement> judge_combined(const Divergence& difference) const {
    const Module& module = walk.shader().module;
    if (circumstances.alone_a == nullptr || difference.judgement.cause != Cause::mismatch ||
        !may_be_contracted(module, module.instructions[difference.instruction]))
      return std::nullopt;
    const SlotView alone = slot_of(circumstances.alone_a->request, circumstances.alone_a->buffer, slot);
    if (difference.position + difference.a.words.size() > alone.words.size() ||
        alone.words[walk.position()] != walk.number())
      return std::nullopt;
    const RecordedWords a = words_at(alone, difference.position, difference.a.components);
    if (a.words == difference.a.words) return std::nullopt;
    Judgement of_alone = judged(difference, a);
    if (a.words == difference.b.words || of_alone.cause != Cause::mismatch)
      return Judgement{.cause = Cause::within_precision,
                       .wrong = WrongDevice::none,
                       .reason = "the first device combines it with other instructions"};
    return of_alone;
  }
};

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

namespace {

/// Adds a difference to its site.
void add(std::map<SiteKey, Site>& sites, Divergence difference) {
  const Cause cause = difference.judgement.cause;
  auto [entry, is_new] = sites.try_emplace(
      {difference.shader, difference.instruction},
      Site{.shader = difference.shader, .instruction = difference.instruction, .causes = {}, .example = {}});
  Site& site = entry->second;
  ++site.differences;
  ++site.causes[static_cast<std::size_t>(cause)];
  if (is_new || gravity(cause) > gravity(site.example.judgement.cause)) site.example = std::move(difference);
}

/// A decision that b had of a, and did not follow.
Divergence ignored_decision(const Walk& walk, std::size_t instruction, std::size_t slot, std::size_t order) {
  return {.shader = &walk.shader(),
          .instruction = instruction,
          .slot = slot,
          .position = walk.position(),
          .order = order,
          .operands = {},
          .a = {},
          .b = {},
          .judgement = {
              .cause = Cause::mismatch, .wrong = WrongDevice::b, .reason = "it goes elsewhere than the decision says"}};
}

}  // namespace

LockstepComparison compare_lockstep(const RecordedLaunch& launch, const Recording& a, const Recording& b,
                                    const Circumstances& circumstances) {
  LockstepComparison result;
  std::map<SiteKey, std::uint64_t> executions;
  std::map<SiteKey, Site> sites;
  for (std::size_t slot = 0; slot < a.request.invocations.size(); ++slot) {
    const SlotView slot_a = slot_of(a.request, a.buffer, slot), slot_b = slot_of(b.request, b.buffer, slot);
    if (!slot_a.complete) ++result.incomplete;
    Walk walk(launch, slot_a);
    bool parted = false;
    const Comparing comparing{walk, slot, circumstances, parted};
    std::size_t order = 0, last_instruction = 0;
    while (walk.next()) {
      const bool same = walk.position() + walk.segment().words <= slot_b.words.size() &&
                        slot_b.words[walk.position()] == walk.number();
      if (!same && !walk.begins_shader() && walk.shader_depth() == 1) {
        // Everything behind it is out of step.
        add(sites, ignored_decision(walk, last_instruction, slot, order));
        break;
      }
      parted = parted || !same;
      for_each_instruction(walk.segment(), [&](std::size_t i, const RecordedValue* value) {
        if (value != nullptr) {
          ++executions[{&walk.shader(), i}];
          if (same) {  // else it is another shader's, or of another block
            ++result.values;
            RecordedWords words_a = walk.words_of(*value);
            RecordedWords words_b = words_at(slot_b, walk.position() + value->offset, value->components);
            if (words_a.words != words_b.words)
              add(sites, comparing.difference(*value, order, std::move(words_a), std::move(words_b)));
          }
          ++order;
        }
        walk.pass(i);
      });
      last_instruction = walk.segment().end_instruction - 1;
    }
    result.parted += parted ? 1 : 0;
  }
  for (auto& [key, site] : sites) {
    site.executions = std::max(executions[key], site.differences);
    result.sites.push_back(std::move(site));
  }
  std::ranges::stable_sort(result.sites, std::greater<>(),
                           [](const Site& site) { return gravity(site.example.judgement.cause); });
  return result;
}

std::set<SiteKey> differing_sites(const RecordedLaunch& launch, const Recording& a, const Recording& b) {
  std::set<SiteKey> sites;
  for (std::size_t slot = 0; slot < a.request.invocations.size(); ++slot) {
    const SlotView slot_b = slot_of(b.request, b.buffer, slot);
    Walk walk(launch, slot_of(a.request, a.buffer, slot));
    while (walk.next()) {
      if (walk.position() + walk.segment().words > slot_b.words.size() ||
          slot_b.words[walk.position()] != walk.number())
        continue;
      for (const RecordedValue& value : walk.segment().values)
        if (walk.words_of(value).words != words_at(slot_b, walk.position() + value.offset, value.components).words)
          sites.emplace(&walk.shader(), value.instruction);
    }
  }
  return sites;
}

FirstDivergence first_divergence(const RecordedLaunch& launch, const Recording& a, const Recording& b, std::size_t slot,
                                 const Circumstances& circumstances) {
  const SlotView slot_a = slot_of(a.request, a.buffer, slot), slot_b = slot_of(b.request, b.buffer, slot);
  Walk walk(launch, slot_a), other(launch, slot_b);
  const bool parted = false;
  const Comparing comparing{walk, slot, circumstances, parted};
  FirstDivergence first;
  std::size_t order = 0;
  while (!first.decision && walk.next() && other.next()) {
    if (walk.number() != other.number()) break;  // another shader: its call has differed
    for_each_instruction(walk.segment(), [&](std::size_t i, const RecordedValue* value) {
      if (value != nullptr) {
        RecordedWords words_a = walk.words_of(*value), words_b = other.words_of(*value);
        if (words_a.words != words_b.words && !first.value)
          first.value = comparing.difference(*value, order, std::move(words_a), std::move(words_b));
        ++order;
      }
      walk.pass(i);
      other.pass(i);
    });
    const std::uint32_t decision = decision_of(walk.shader(), walk.segment());
    std::optional<RecordedWords> words_a = walk.value_of(decision), words_b = other.value_of(decision);
    if (words_a && words_b && words_a->words != words_b->words)
      first.decision = comparing.difference_of(walk.shader().module.definitions.at(decision), walk.position(), false,
                                               order, std::move(*words_a), std::move(*words_b));
  }
  return first;
}

}  // namespace tandem::program
