#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "program/lockstep/atomics.hpp"
#include "program/lockstep/comparison.hpp"
#include "program/lockstep/recorded_execution.hpp"
#include "rhi/glsl/compile.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

constexpr std::uint32_t invocation_count = 16;

/// Every invocation draws a ticket, and adds to a counter of its own.
Job tickets() {
  return {.shaders = {{.name = "tickets",
                       .spirv = glsl::compile(R"(#version 460
            layout(local_size_x = 4) in;
            layout(set = 0, binding = 0) buffer Tickets { uint next; uint drawn[16]; uint own[16]; };
            void main() {
              drawn[gl_GlobalInvocationID.x] = atomicAdd(next, 1u);
              atomicAdd(own[gl_GlobalInvocationID.x], 1u);
            })",
                                              rhi::ShaderStage::compute, "tickets")}},
          .buffers = {{.name = "tickets", .initial = std::vector<std::byte>(std::size_t{4} * 33)}},
          .pipelines = {{.name = "tickets",
                         .stages = ComputeStages{},
                         .bindings = {{.set = 0, .binding = 0, .resource = BufferUse{.buffer = 0}}}}},
          .commands = {Dispatch{.workgroup_count = {invocation_count / 4, 1, 1}}}};
}

/// What a device recorded of the tickets.
struct RecordedTickets {
  RecordedLaunch launch;
  Recording recording;

  /// The word that holds what the invocation's first or second atomic returned.
  std::uint32_t& old_value(Recording& of, std::size_t slot, int atomic) const {
    Walk walk(launch, slot_of(recording.request, recording.buffer, slot));
    while (walk.next())
      for (const RecordedValue& value : walk.segment().values)
        if (walk.shader().module.instructions[value.instruction].op == spv::OpAtomicIAdd && atomic-- == 0) {
          const std::span<const std::uint32_t> words = slot_of(of.request, of.buffer, slot).words;
          return of.buffer[static_cast<std::size_t>(words.data() - of.buffer.data()) + walk.position() + value.offset];
        }
    FAIL("there is no such atomic");
    std::abort();
  }
};

RecordedTickets record_tickets(const std::string& device_name) {
  const Job job = tickets();
  RecordedLaunch launch = record_launch(job, job.commands[0], RecordForm::record);
  std::vector<std::uint64_t> all(invocation_count);
  std::iota(all.begin(), all.end(), std::uint64_t{0});
  // With one lane: g++ takes long over wide kernels that record.
  RecordedExecution execution(*test::device(device_name == "cpu" ? "cpu-scalar" : device_name), launch,
                              {.buffers = {job.buffers[0].initial}, .images = {}});
  Recording recording = execution.record(std::move(all), 1 << 20);
  return {std::move(launch), std::move(recording)};
}

}  // namespace

TANDEM_DEVICE_TEST("tickets that were drawn in another order are contended, and no device is wrong") {
  const RecordedTickets tickets = record_tickets(device_name);
  Recording other = tickets.recording;
  std::swap(tickets.old_value(other, 2, 0), tickets.old_value(other, 13, 0));
  const AtomicFindings findings = judge_atomics(tickets.launch, tickets.recording, other);
  CHECK(findings.wrong.empty());
  REQUIRE(findings.contended.size() == 1);  // a counter of one's own is not

  // So it is order also where the launch in lockstep has come out alike, which leaves nothing else to tell by.
  const Circumstances circumstances{.order_dependent = findings.contended};
  const AtomicFindings alike = judge_atomics(tickets.launch, tickets.recording, tickets.recording);
  CHECK(alike.contended == findings.contended);
  const FirstDivergence first = first_divergence(tickets.launch, tickets.recording, other, 2, circumstances);
  REQUIRE(first.value);
  CHECK(first.value->judgement.cause == Cause::order);
  CHECK_FALSE(first_divergence(tickets.launch, tickets.recording, other, 3, circumstances).value);
}

TANDEM_DEVICE_TEST("a ticket that is drawn twice, or left out, shows which device is wrong") {
  const RecordedTickets tickets = record_tickets(device_name);
  for (const std::uint32_t wrong : {0u, 17u}) {
    // No start of a chain may make up for it: neither the first ticket nor the last.
    std::size_t slot = 0;
    Recording other = tickets.recording;
    while (tickets.old_value(other, slot, 0) != 7) ++slot;
    tickets.old_value(other, slot, 0) = wrong;
    const AtomicFindings of_b = judge_atomics(tickets.launch, tickets.recording, other);
    REQUIRE(of_b.wrong.size() == 1);
    CHECK(of_b.wrong.begin()->second == WrongDevice::b);
    CHECK(of_b.contended.empty());
    const AtomicFindings of_a = judge_atomics(tickets.launch, other, tickets.recording);
    REQUIRE(of_a.wrong.size() == 1);
    CHECK(of_a.wrong.begin()->second == WrongDevice::a);
  }
}
