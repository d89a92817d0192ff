#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "program/execute/execution.hpp"
#include "program/lockstep/recorded_launch.hpp"
#include "program/lockstep/snapshot.hpp"
#include "program/record/recording.hpp"

namespace tandem::program {

/// What the invocations of a request wrote.
struct Recording {
  RecordRequest request;
  std::vector<std::uint32_t> buffer;
};

/// A launch that records, on a device. Every run begins with the same contents.
class RecordedExecution {
 public:
  /// Throws rhi::Error. `device` and `launch` outlive the execution. @param inputs of the job's buffers and images
  RecordedExecution(rhi::Device& device, const RecordedLaunch& launch, const Snapshot& inputs);

  /// RecordForm::hash: a word for each invocation of the launch.
  std::vector<std::uint32_t> hashes();

  /// RecordForm::record: words of the longest record of these invocations.
  std::uint64_t needed_words(std::vector<std::uint64_t> invocations);

  /// RecordForm::record: everything that the invocations compute, in at most `most_bytes` of memory; what does not fit
  /// is cut off (SlotView::complete).
  Recording record(std::vector<std::uint64_t> invocations, std::uint64_t most_bytes);

  /// RecordForm::lockstep: the invocations of `other` once more. @param force whether each instruction's result is
  /// replaced by the recorded one, so that the next ones have the same operands
  Recording replay(const Recording& other, bool force);

  const RecordedLaunch& launch() const noexcept { return launch_; }

  /// What the job's resources hold after the last run.
  Snapshot outputs();

 private:
  std::vector<std::uint32_t> run(const RecordRequest& request, std::span<const std::uint32_t> other, bool force);

  rhi::Device& device_;
  const RecordedLaunch& launch_;
  Snapshot inputs_;
  Execution execution_;
};

}  // namespace tandem::program
