#include "program/lockstep/atomics.hpp"

#include <algorithm>
#include <optional>
#include <tuple>
#include <vector>

#include "program/lockstep/walk.hpp"

namespace tandem::program {
namespace {

/// An atomic of one invocation.
struct AtomicUse {
  SiteKey site;
  spv::Op op;
  std::uint32_t operand;
  std::uint32_t old_a, old_b;
};

/// A word in memory: its variable, the indices that lead to it, and of shared memory the workgroup.
using Location = std::tuple<const RecordedShader*, std::uint32_t, std::vector<std::uint32_t>, std::uint64_t>;

std::optional<std::uint32_t> result_of(spv::Op op, std::uint32_t old, std::uint32_t operand) {
  const auto x = static_cast<std::int32_t>(old), y = static_cast<std::int32_t>(operand);
  switch (op) {
    case spv::OpAtomicIAdd:
      return old + operand;
    case spv::OpAtomicISub:
      return old - operand;
    case spv::OpAtomicUMin:
      return std::min(old, operand);
    case spv::OpAtomicUMax:
      return std::max(old, operand);
    case spv::OpAtomicSMin:
      return x < y ? old : operand;
    case spv::OpAtomicSMax:
      return x > y ? old : operand;
    case spv::OpAtomicAnd:
      return old & operand;
    case spv::OpAtomicOr:
      return old | operand;
    case spv::OpAtomicXor:
      return old ^ operand;
    case spv::OpAtomicExchange:
      return operand;
    default:
      return std::nullopt;
  }
}

/// Whether the old values form a chain that begins with `start`.
bool is_chain_from(std::uint32_t start, const std::vector<AtomicUse>& uses, std::uint32_t AtomicUse::*old) {
  std::map<std::uint32_t, std::vector<const AtomicUse*>> changing;
  std::map<std::uint32_t, std::size_t> staying;
  for (const AtomicUse& use : uses) {
    if (*result_of(use.op, use.*old, use.operand) == use.*old)
      ++staying[use.*old];
    else
      changing[use.*old].push_back(&use);
  }
  std::size_t taken = 0;
  for (std::uint32_t value = start;;) {
    if (const auto found = staying.find(value); found != staying.end()) {
      taken += found->second;
      staying.erase(found);
    }
    const auto found = changing.find(value);
    if (found == changing.end() || found->second.empty()) return taken == uses.size();
    const AtomicUse* use = found->second.back();
    found->second.pop_back();
    ++taken;
    value = *result_of(use->op, use->*old, use->operand);
  }
}

bool is_chain(const std::vector<AtomicUse>& uses, std::uint32_t AtomicUse::*old) {
  constexpr std::size_t most_starts = 64;
  std::set<std::uint32_t> starts;
  for (const AtomicUse& use : uses)
    if (starts.size() < most_starts) starts.insert(use.*old);
  return std::ranges::any_of(starts, [&](std::uint32_t start) { return is_chain_from(start, uses, old); });
}

/// The variable that an atomic works on, and the indices into it; nothing where an index is not known.
std::optional<std::pair<std::uint32_t, std::vector<std::uint32_t>>> place_of(const Walk& walk, std::uint32_t pointer) {
  const Module& module = walk.shader().module;
  std::vector<std::uint32_t> indices;
  for (;;) {
    const Instruction& instruction = definition(module, pointer);
    if (instruction.op == spv::OpVariable) return std::pair(pointer, indices);
    if (instruction.op != spv::OpAccessChain && instruction.op != spv::OpInBoundsAccessChain) return std::nullopt;
    std::vector<std::uint32_t> own;
    for (std::size_t i = 4; i < instruction.words.size(); ++i) {
      const std::optional<RecordedWords> index = walk.value_of(instruction.words[i]);
      if (!index) return std::nullopt;
      own.push_back(index->words[0]);
    }
    indices.insert(indices.begin(), own.begin(), own.end());
    pointer = instruction.words[3];
  }
}

std::uint64_t workgroup_of(const RecordedLaunch& launch, const RecordRequest& request, std::size_t slot) {
  const std::array<std::uint32_t, 3> id = id_of(request, request.invocations[slot]);
  std::uint64_t group = 0;
  for (std::size_t axis = 3; axis-- > 0;)
    group = group * (launch.size[axis] / launch.workgroup_size[axis] + 1) + id[axis] / launch.workgroup_size[axis];
  return group;
}

std::map<Location, std::vector<AtomicUse>> uses_of(const RecordedLaunch& launch, const Recording& a,
                                                   const Recording& b) {
  std::map<Location, std::vector<AtomicUse>> uses;
  for (std::size_t slot = 0; slot < a.request.invocations.size(); ++slot) {
    const SlotView slot_b = slot_of(b.request, b.buffer, slot);
    Walk walk(launch, slot_of(a.request, a.buffer, slot));
    while (walk.next()) {
      const Module& module = walk.shader().module;
      for (std::size_t i = walk.segment().first_instruction; i < walk.segment().end_instruction; ++i) {
        const Instruction& instruction = module.instructions[i];
        if (result_of(instruction.op, 0, 0)) {
          const auto value = std::ranges::find(walk.segment().values, i, &RecordedValue::instruction);
          const auto place = place_of(walk, instruction.words[3]);
          const std::optional<RecordedWords> operand = walk.value_of(instruction.words[6]);
          const std::size_t position = value == walk.segment().values.end() ? 0 : walk.position() + value->offset;
          if (place && operand && operand->words.size() == 1 && position != 0 && position < slot_b.words.size()) {
            const bool is_shared = definition(module, place->first).words[3] == spv::StorageClassWorkgroup;
            uses[{&walk.shader(), place->first, place->second, is_shared ? workgroup_of(launch, a.request, slot) : 0}]
                .push_back({{&walk.shader(), i},
                            instruction.op,
                            operand->words[0],
                            walk.words_of(*value).words[0],
                            slot_b.words[position]});
          }
        }
        walk.pass(i);
      }
    }
  }
  return uses;
}

}  // namespace

AtomicFindings judge_atomics(const RecordedLaunch& launch, const Recording& a, const Recording& b) {
  AtomicFindings findings;
  for (const auto& [location, uses] : uses_of(launch, a, b)) {
    const bool of_a = is_chain(uses, &AtomicUse::old_a), of_b = is_chain(uses, &AtomicUse::old_b);
    for (const AtomicUse& use : uses) {
      // Where neither is one, memory is written in other ways too.
      if (of_a != of_b) findings.wrong.emplace(use.site, of_a ? WrongDevice::b : WrongDevice::a);
      if (of_a && of_b && uses.size() > 1) findings.contended.insert(use.site);
    }
  }
  return findings;
}

std::set<std::pair<const RecordedShader*, std::uint32_t>> variables_of(const std::map<SiteKey, WrongDevice>& atomics) {
  std::set<std::pair<const RecordedShader*, std::uint32_t>> variables;
  for (const auto& [site, device] : atomics) {
    const Module& module = site.first->module;
    std::uint32_t pointer = module.instructions[site.second].words[3];
    while (definition(module, pointer).op != spv::OpVariable) pointer = definition(module, pointer).words[3];
    variables.emplace(site.first, pointer);
  }
  return variables;
}

}  // namespace tandem::program
