#pragma once

#include <cstddef>
#include <vector>

#include "program/execute/execution.hpp"
#include "program/job/job.hpp"

/// What the buffers and images of a job hold, so that a command can run on any device with the same inputs.
namespace tandem::program {

struct Snapshot {
  std::vector<std::vector<std::byte>> buffers;  ///< by position in Job::buffers
  std::vector<std::vector<std::byte>> images;   ///< likewise
};

Snapshot snapshot_of(Execution& execution, const Job& job);

/// Writes the contents into an execution of the same job, or of one with more buffers.
void restore(Execution& execution, const Snapshot& snapshot);

}  // namespace tandem::program
