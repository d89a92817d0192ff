#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "program/job/job.hpp"
#include "program/lockstep/comparison.hpp"
#include "program/lockstep/recorded_execution.hpp"
#include "rhi/device.hpp"

/// Why two devices disagree about a job, down to the instruction.
namespace tandem::program {

struct ExplainOptions {
  /// Position in Job::commands; absent: the first command in which an invocation computes other bits.
  std::optional<std::size_t> command = {};
  /// The only one to look at; absent: those that compute other bits, as many as fit.
  std::optional<std::array<std::uint32_t, 3>> invocation = {};
  std::uint64_t most_bytes = std::uint64_t{1} << 28;  ///< of a recording
  std::size_t most_invocations = 4096;
  /// Runs the command on device a once more, the last invocation first, to know which values depend on that order.
  bool check_order = true;
  rhi::Device* exact = nullptr;  ///< decides about rays, as RayArbiter does; null: nobody does
};

/// Whether an output (a buffer or an image) holds the same bytes.
struct OutputState {
  bool is_image = false;
  std::size_t index = 0;     ///< position in Job::buffers or Job::images
  bool plain_equal = true;   ///< a and b, as they run without recording
  bool forced_equal = true;  ///< a, and b forced along it; true where not all invocations were recorded
  bool record_changed_a = false, record_changed_b = false;  ///< against the device's own run without recording
  bool order_changed = false;                               ///< of a, with the last invocation first
};

struct Explanation {
  std::size_t command = 0;
  std::uint64_t launched = 0;               ///< invocations
  std::optional<std::uint64_t> other_bits;  ///< of them computed others; absent where all were recorded, or one
  bool all_recorded = false;                ///< else the second device's memory is that of its own values, too
  std::unique_ptr<RecordedLaunch> launch;   ///< null: no command runs shaders
  Recording a, forced, free;                ///< a's recording; b forced along it, and b on its own
  LockstepComparison lockstep;              ///< a against `forced`
  std::vector<FirstDivergence> first;       ///< by slot, a against `free`
  std::vector<OutputState> outputs;         ///< those that the command can write
  std::optional<std::size_t> slot;          ///< that is worth to be shown: the gravest, or the chosen one
};

/// The devices run the commands before the explained one each on their own; both then begin with what a's left.
/// Throws rhi::Error, and Cancelled.
Explanation explain(rhi::Device& a, rhi::Device& b, const Job& job, const ExplainOptions& options);

/// The gravest cause of the lockstep comparison and of the outputs; equal where nothing differs.
Cause gravest(const Explanation& explanation);

}  // namespace tandem::program
