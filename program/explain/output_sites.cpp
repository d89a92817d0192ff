#include "program/explain/output_sites.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "program/lockstep/addresses.hpp"
#include "program/lockstep/walk.hpp"

namespace tandem::program {
namespace {

/// The pointer through which an instruction writes; 0 where it writes none.
std::uint32_t written_pointer(const Instruction& instruction) {
  if (instruction.op == spv::OpStore) return instruction.words[1];
  const bool is_atomic = instruction.op >= spv::OpAtomicExchange && instruction.op <= spv::OpAtomicXor;
  if (is_atomic || instruction.op == spv::OpAtomicFAddEXT || instruction.op == spv::OpAtomicFMinEXT ||
      instruction.op == spv::OpAtomicFMaxEXT)
    return instruction.words[3];
  return instruction.op == spv::OpAtomicStore ? instruction.words[1] : 0;
}

/// The buffer that a pipeline binds there.
std::optional<std::size_t> buffer_at(const Pipeline& pipeline, const DescriptorPlace& place, std::uint64_t& offset) {
  for (const Binding& binding : pipeline.bindings)
    if (binding.set == place.set && binding.binding == place.binding)
      if (const auto* use = std::get_if<BufferUse>(&binding.resource)) {
        offset += use->offset;
        return use->buffer;
      }
  return std::nullopt;
}

bool differs_in(const std::vector<std::byte>& a, const std::vector<std::byte>& b, std::uint64_t offset,
                std::uint64_t size) {
  const std::uint64_t end = std::min<std::uint64_t>(offset + size, a.size());
  for (std::uint64_t i = offset; i < end; ++i)
    if (a[i] != b[i]) return true;
  return false;
}

/// Whose memory holds the value that an OpStore of words stored.
WrongDevice wrong_device(const Walk& walk, const Instruction& instruction, const std::vector<std::byte>& a,
                         const std::vector<std::byte>& b, std::uint64_t offset) {
  if (instruction.op != spv::OpStore) return WrongDevice::unknown;
  const std::optional<RecordedWords> stored = walk.value_of(instruction.words[2]);
  if (!stored || std::ranges::any_of(stored->components, [](const Component& each) { return each.width != 32; }))
    return WrongDevice::unknown;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(stored->words));
  const auto holds = [&](const std::vector<std::byte>& memory) {
    return offset + bytes.size() <= memory.size() &&
           std::ranges::equal(bytes, std::span(memory).subspan(offset, bytes.size()));
  };
  const bool of_a = holds(a), of_b = holds(b);
  return of_a == of_b ? WrongDevice::unknown : of_a ? WrongDevice::b : WrongDevice::a;
}

}  // namespace

std::vector<Site> output_sites(const RecordedLaunch& launch, const Recording& recording, const Snapshot& a,
                               const Snapshot& b, std::span<const char> ignored) {
  std::map<SiteKey, Site> sites;
  for (std::size_t slot = 0; slot < recording.request.invocations.size(); ++slot) {
    Walk walk(launch, slot_of(recording.request, recording.buffer, slot));
    std::size_t order = 0;
    while (walk.next()) {
      for (std::size_t i = walk.segment().first_instruction; i < walk.segment().end_instruction; ++i) {
        const Instruction& instruction = walk.shader().module.instructions[i];
        if (const std::uint32_t pointer = written_pointer(instruction); pointer != 0)
          if (const std::optional<BlockRange> range = block_range(walk, pointer))
            if (const auto place = descriptor_of(walk.shader().module, range->variable)) {
              std::uint64_t offset = range->offset;
              const std::optional<std::size_t> buffer = buffer_at(launch.job.pipelines[0], *place, offset);
              if (buffer && *buffer < ignored.size()) {
                const SiteKey key{&walk.shader(), i};
                Site& site =
                    sites.try_emplace(key, Site{.shader = key.first, .instruction = i, .causes = {}, .example = {}})
                        .first->second;
                ++site.executions;
                if (!ignored[*buffer] && differs_in(a.buffers[*buffer], b.buffers[*buffer], offset, range->size)) {
                  if (site.differences++ == 0)
                    site.example = {.shader = key.first,
                                    .instruction = i,
                                    .slot = slot,
                                    .position = walk.position(),
                                    .order = order,
                                    .operands = {},
                                    .a = {},
                                    .b = {},
                                    .judgement = {.cause = Cause::mismatch,
                                                  .wrong = wrong_device(walk, instruction, a.buffers[*buffer],
                                                                        b.buffers[*buffer], offset),
                                                  .reason = "what it wrote is not in memory afterwards"}};
                  ++site.causes[static_cast<std::size_t>(Cause::mismatch)];
                }
              }
            }
        walk.pass(i);
      }
      order += walk.segment().values.size();
    }
  }
  std::vector<Site> result;
  for (auto& [key, site] : sites)
    if (site.differences != 0) result.push_back(std::move(site));
  return result;
}

}  // namespace tandem::program
