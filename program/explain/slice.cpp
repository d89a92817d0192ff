#include "program/explain/slice.hpp"

#include <deque>
#include <unordered_set>

#include "program/lockstep/walk.hpp"

namespace tandem::program {
namespace {

bool only_moves(spv::Op op) { return op == spv::OpLoad || op == spv::OpCompositeExtract || op == spv::OpCopyObject; }

/// Goes to where the difference is: all before it has passed.
bool go_to(Walk& walk, const Divergence& difference) {
  while (walk.next())
    for (std::size_t i = walk.segment().first_instruction; i < walk.segment().end_instruction; ++i) {
      const bool is_in_segment =
          difference.position >= walk.position() && difference.position < walk.position() + walk.segment().words;
      if (is_in_segment && &walk.shader() == difference.shader && i == difference.instruction) return true;
      walk.pass(i);
    }
  return false;
}

}  // namespace

std::vector<SliceEntry> slice_of(const RecordedLaunch& launch, const Recording& recording, const Divergence& difference,
                                 std::size_t most) {
  const SlotView slot = slot_of(recording.request, recording.buffer, difference.slot);
  Walk walk(launch, slot);
  std::vector<SliceEntry> slice;
  if (!go_to(walk, difference)) return slice;
  const Module& module = difference.shader->module;
  std::unordered_set<std::size_t> seen = {difference.instruction};
  std::deque<std::size_t> open = {difference.instruction};
  while (!open.empty() && slice.size() < most) {
    const Instruction& instruction = module.instructions[open.front()];
    open.pop_front();
    std::vector<std::size_t> sources;
    for (const std::uint16_t used : instruction.used_ids)
      if (const auto found = module.definitions.find(instruction.words[used]);
          found != module.definitions.end() && found->second >= module.first_function)
        sources.push_back(found->second);
    if (instruction.op == spv::OpLoad)
      if (const std::optional<std::size_t> store = walk.last_store(instruction.words[3])) sources.push_back(*store);
    for (const std::size_t source : sources) {
      if (!seen.insert(source).second) continue;
      open.push_back(source);
      const Instruction& from = module.instructions[source];
      const bool has_source = from.op != spv::OpLoad || walk.last_store(from.words[3]).has_value();
      if (only_moves(from.op) && has_source) continue;
      if (std::optional<RecordedWords> value = walk.value_of(from.result)) slice.push_back({source, std::move(*value)});
    }
  }
  if (slice.size() > most) slice.resize(most);
  return slice;
}

}  // namespace tandem::program
