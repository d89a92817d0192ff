#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "program/job/job.hpp"
#include "program/print/print_code.hpp"

/// What the shaders of a job print by debugPrintfEXT.
namespace tandem::program {

/// A job whose shaders write what they print into a buffer.
struct PrintingJob {
  Job job;                 ///< with one buffer more, behind the others
  std::size_t buffer = 0;  ///< its position in Job::buffers; its contents before each command are the initial ones
  std::vector<PrintCall> calls;
};

/// The job's own shaders print; nothing where none of them does. Throws rhi::Error, which names the line, for a format
/// that is wrong.
/// @param most_lines that are kept of a command
std::optional<PrintingJob> printing_job(const Job& job, std::uint32_t most_lines);

/// The calls of the job's shaders, with their places and formats. Throws as printing_job.
std::vector<PrintCall> print_calls(const Job& job);

struct PrintedLine {
  std::array<std::uint32_t, 3> invocation = {};  ///< gl_GlobalInvocationID, or gl_LaunchIDEXT
  std::string text;                              ///< without the newline at its end
};

/// What a command has printed.
struct PrintedLines {
  /// By invocation (z, then y, then x), and of one invocation in the order of its execution.
  std::vector<PrintedLine> lines;
  std::uint64_t left_out = 0;  ///< those that found no place; which ones is up to chance
};

/// @param contents of the buffer after the command
PrintedLines printed_lines(const PrintingJob& printing, std::span<const std::byte> contents);

}  // namespace tandem::program
