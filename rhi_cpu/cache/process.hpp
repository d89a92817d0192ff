#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tandem::cpu {

struct ProcessResult {
  int exit_code = 0;   ///< 128 + the signal's number for a process that a signal ended
  std::string output;  ///< standard output and standard error, as they came
};

/// Runs a program to its end, without a shell and with nothing to read. Messages come in English (LC_ALL=C).
/// @param arguments the program's path, then its arguments
/// @return nothing when the program cannot be started
std::optional<ProcessResult> run_process(const std::vector<std::string>& arguments);

}  // namespace tandem::cpu
