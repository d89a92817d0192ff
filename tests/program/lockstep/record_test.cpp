#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "program/lockstep/recorded_execution.hpp"
#include "program/lockstep/walk.hpp"
#include "program/record/contraction.hpp"
#include "rhi/glsl/compile.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

using Words = std::vector<std::uint32_t>;

std::vector<std::byte> bytes_of(const Words& values) {
  const auto bytes = std::as_bytes(std::span(values));
  return {bytes.begin(), bytes.end()};
}

/// Loops, functions that write through their parameters, shared memory, barriers, a switch, matrices, booleans and
/// structures: a word of `result` for each of 32 invocations in two workgroups.
constexpr const char* busy = R"(#version 460
  layout(local_size_x = 4, local_size_y = 4) in;
  layout(set = 0, binding = 0) readonly buffer In { float values[]; };
  layout(set = 0, binding = 3) buffer Out { uint result[]; };
  struct State { float sum; bvec2 flags; ivec3 counts; };
  shared float tile[16];
  float quarter(float x, out float rest) {
    if (x < 1.0) { rest = x; return 0.0; }
    rest = fract(x);
    return floor(x * 0.25);
  }
  void main() {
    uint local = gl_LocalInvocationIndex;
    uint i = gl_WorkGroupID.x * 16u + local;
    State state = State(0.0, bvec2(false), ivec3(0));
    tile[local] = values[i];
    barrier();
    for (uint k = 0u; k <= local % 5u; ++k) {
      float rest;
      float whole = quarter(tile[(local + k) % 16u], rest);
      state.sum += whole * float(k + 1u) - rest;
      state.flags = bvec2(state.flags.y, whole > rest);
      if (state.flags.x) continue;
      switch (int(whole) % 3) {
        case 0: state.counts.x += 2;
        case 1: state.counts.y += 3; break;
        default: state.counts.z -= 1;
      }
    }
    mat2x3 m = mat2x3(state.sum, 1.0, 2.0, -state.sum, 0.5, 0.25);
    vec3 v = m * vec2(0.5, float(state.counts.y));
    barrier();
    result[i] = floatBitsToUint(v.x + v.y + v.z) ^ uint(state.counts.x * 31 + state.counts.z) ^ uint(state.flags.y);
  }
)";

/// The device, with one lane: g++ takes long over wide kernels that record.
rhi::Device& recording(const std::string& device_name) {
  return *test::device(device_name == "cpu" ? "cpu-scalar" : device_name);
}

Job busy_job() {
  Words values(32);
  for (std::uint32_t i = 0; i < 32; ++i) {
    const float value = static_cast<float>(i * 7 % 23) * 0.37f;
    std::memcpy(&values[i], &value, 4);
  }
  return {
      .shaders = {{.name = "busy",  // Recording holds a driver back from rearranging arithmetic, unless nothing may be
                                    // rearranged anyway.
                   .spirv = without_contraction(
                       parse_module(glsl::compile(busy, rhi::ShaderStage::compute, "busy"), "busy"))}},
      .buffers = {{.name = "values", .initial = bytes_of(values)}, {.name = "result", .initial = bytes_of(Words(32))}},
      .pipelines = {{.name = "busy",
                     .stages = ComputeStages{},
                     .bindings = {{.set = 0, .binding = 0, .resource = BufferUse{.buffer = 0}},
                                  {.set = 0, .binding = 3, .resource = BufferUse{.buffer = 1}}}}},
      .commands = {Dispatch{.workgroup_count = {2, 1, 1}}}};
}

Snapshot inputs_of(const Job& job) {
  Snapshot inputs;
  for (const Buffer& buffer : job.buffers) inputs.buffers.push_back(buffer.initial);
  return inputs;
}

std::vector<std::uint64_t> all_of(const RecordedLaunch& launch) {
  std::vector<std::uint64_t> all(launch.size[0] * launch.size[1] * launch.size[2]);
  std::iota(all.begin(), all.end(), std::uint64_t{0});
  return all;
}

constexpr std::uint64_t plenty = 1 << 26;

}  // namespace

TANDEM_DEVICE_TEST("a shader that records computes the same bits, in every form") {
  const Job job = busy_job();
  Execution plain(device, job);
  plain.run();
  const std::vector<std::byte> expected = plain.buffer(1);
  CHECK(expected != job.buffers[1].initial);
  const Snapshot inputs = inputs_of(job);

  const RecordedLaunch to_hash = record_launch(job, job.commands[0], RecordForm::hash);
  RecordedExecution hash(recording(device_name), to_hash, inputs);
  const Words hashes = hash.hashes();
  CHECK(hashes.size() == 32);
  CHECK(hash.outputs().buffers[1] == expected);
  CHECK(hash.hashes() == hashes);

  const RecordedLaunch to_record = record_launch(job, job.commands[0], RecordForm::record);
  RecordedExecution recorder(recording(device_name), to_record, inputs);
  const Recording recorded = recorder.record(all_of(to_record), plenty);
  CHECK(recorder.outputs().buffers[1] == expected);

  const RecordedLaunch to_replay = record_launch(job, job.commands[0], RecordForm::lockstep);
  RecordedExecution replayer(recording(device_name), to_replay, inputs);
  for (const bool force : {false, true}) {
    const Recording replayed = replayer.replay(recorded, force);
    CHECK(replayer.outputs().buffers[1] == expected);
    for (std::size_t slot = 0; slot < 32; ++slot) {
      const SlotView a = slot_of(recorded.request, recorded.buffer, slot);
      const SlotView b = slot_of(replayed.request, replayed.buffer, slot);
      CHECK(a.complete);
      CHECK(a.words.size() > 100);
      CHECK(std::ranges::equal(a.words, b.words));
    }
  }
}

TANDEM_DEVICE_TEST("a record is read back segment by segment, with what every id holds") {
  const Job job = busy_job();
  const RecordedLaunch launch = record_launch(job, job.commands[0], RecordForm::record);
  RecordedExecution recorder(recording(device_name), launch, inputs_of(job));
  const Recording recorded = recorder.record({21, 3}, plenty);
  const std::vector<std::byte> result = recorder.outputs().buffers[1];
  // Invocation 21 of the launch, whose rows have 8 invocations, is x = 5, y = 2: local index 9 of the second workgroup.
  const std::uint32_t indices[] = {16 + 9, 3};
  for (std::size_t slot = 0; slot < 2; ++slot) {
    Walk walk(launch, slot_of(recorded.request, recorded.buffer, slot));
    std::size_t words = 0;
    std::uint32_t stored = 0;
    std::size_t deepest = 0;
    while (walk.next()) {
      words += walk.segment().words;
      deepest = std::max(deepest, walk.depth());
      for (std::size_t i = walk.segment().first_instruction; i < walk.segment().end_instruction; ++i) {
        const Instruction& instruction = walk.shader().module.instructions[i];
        if (instruction.op == spv::OpFAdd) {
          const auto x = walk.value_of(instruction.words[3]), y = walk.value_of(instruction.words[4]);
          REQUIRE(x);
          REQUIRE(y);
        }
        if (instruction.op == spv::OpStore)
          if (const auto value = walk.value_of(instruction.words[2]); value && value->words.size() == 1)
            stored = value->words[0];
        walk.pass(i);
      }
    }
    CHECK(words == slot_of(recorded.request, recorded.buffer, slot).words.size());
    CHECK(deepest == 2);
    std::uint32_t written = 0;
    std::memcpy(&written, result.data() + 4 * indices[slot], 4);
    CHECK(stored == written);
  }
}

TANDEM_DEVICE_TEST("forced along another record, a shader goes on with its values") {
  const Job job = busy_job();
  const RecordedLaunch to_record = record_launch(job, job.commands[0], RecordForm::record);
  RecordedExecution recorder(recording(device_name), to_record, inputs_of(job));
  const Recording recorded = recorder.record(all_of(to_record), plenty);
  const std::vector<std::byte> expected = recorder.outputs().buffers[1];
  // The replay gets other inputs; each load says so, and all else has the recorded operands.
  Snapshot others = inputs_of(job);
  std::ranges::reverse(others.buffers[0]);
  const RecordedLaunch to_replay = record_launch(job, job.commands[0], RecordForm::lockstep);
  RecordedExecution replayer(recording(device_name), to_replay, others);
  const Recording replayed = replayer.replay(recorded, true);
  CHECK(replayer.outputs().buffers[1] == expected);
  std::size_t different = 0;
  for (std::size_t slot = 0; slot < 32; ++slot) {
    const SlotView a = slot_of(recorded.request, recorded.buffer, slot);
    const SlotView b = slot_of(replayed.request, replayed.buffer, slot);
    REQUIRE(a.words.size() == b.words.size());
    for (std::size_t i = 0; i < a.words.size(); ++i) different += a.words[i] != b.words[i];
  }
  CHECK(different >= 30);
  CHECK(different <= 32);  // one load of an input in each invocation
}

TANDEM_DEVICE_TEST("a slot that is too small says how many words it needs") {
  const Job job = busy_job();
  const RecordedLaunch launch = record_launch(job, job.commands[0], RecordForm::record);
  RecordedExecution recorder(recording(device_name), launch, inputs_of(job));
  const Recording whole = recorder.record({0}, plenty);
  const SlotView all = slot_of(whole.request, whole.buffer, 0);
  const std::uint64_t fixed = record_buffer_size(
      {.launch_size = launch.size, .invocations = {0}, .capacity = 0, .largest_segment = launch.largest_segment},
      false);
  const Recording cut = recorder.record({0}, 2 * (fixed + 4 * 100));
  const SlotView part = slot_of(cut.request, cut.buffer, 0);
  CHECK_FALSE(part.complete);
  CHECK(part.words.size() == 100);
  CHECK(part.needed_words == all.words.size());
  Walk walk(launch, part);
  std::size_t words = 0;
  while (walk.next()) words += walk.segment().words;
  CHECK(words > 50);
  CHECK(std::ranges::equal(part.words.first(words), all.words.first(words)));
}

/// The words of a replay of all invocations that are others than the record's.
std::size_t count_differences(const Recording& a, const Recording& b) {
  std::size_t different = 0;
  for (std::size_t slot = 0; slot < a.request.invocations.size(); ++slot) {
    const SlotView of_a = slot_of(a.request, a.buffer, slot), of_b = slot_of(b.request, b.buffer, slot);
    for (std::size_t i = 0; i < of_a.words.size(); ++i) different += of_a.words[i] != of_b.words[i];
  }
  return different;
}

TANDEM_DEVICE_TEST("mirrored, a launch computes the same, but for what depends on the order of invocations") {
  const Job job = busy_job();
  const RecordedLaunch to_record = record_launch(job, job.commands[0], RecordForm::record);
  RecordedExecution recorder(recording(device_name), to_record, inputs_of(job));
  const Recording recorded = recorder.record(all_of(to_record), plenty);
  const RecordedLaunch to_mirror = record_launch(job, job.commands[0], RecordForm::lockstep, true);
  RecordedExecution mirror(recording(device_name), to_mirror, inputs_of(job));
  for (const bool force : {false, true}) {
    CHECK(count_differences(recorded, mirror.replay(recorded, force)) == 0);
    CHECK(mirror.outputs().buffers[1] == recorder.outputs().buffers[1]);
  }

  // One workgroup: which of several comes first is open.
  Job tickets = job;
  tickets.commands = {Dispatch{.workgroup_count = {1, 1, 1}}};
  tickets.shaders[0].spirv = glsl::compile(R"(#version 460
    layout(local_size_x = 8) in;
    layout(set = 0, binding = 3) buffer Out { uint next; uint result[]; };
    void main() { result[gl_GlobalInvocationID.x] = atomicAdd(next, 1u) * 2u; })",
                                           rhi::ShaderStage::compute, "tickets");
  const RecordedLaunch to_record_tickets = record_launch(tickets, tickets.commands[0], RecordForm::record);
  RecordedExecution ticket_recorder(recording(device_name), to_record_tickets, inputs_of(job));
  const Recording of_tickets = ticket_recorder.record(all_of(to_record_tickets), plenty);
  const RecordedLaunch to_mirror_tickets = record_launch(tickets, tickets.commands[0], RecordForm::lockstep, true);
  RecordedExecution ticket_mirror(recording(device_name), to_mirror_tickets, inputs_of(job));
  // Every invocation draws another ticket; its product has the recorded operand.
  CHECK(count_differences(of_tickets, ticket_mirror.replay(of_tickets, true)) == 8);
}
