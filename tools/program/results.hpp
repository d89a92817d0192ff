#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "program/compare/comparison.hpp"
#include "tools/output/output_file.hpp"
#include "tools/program/job_builder.hpp"

/// What a run leaves in its resources.
namespace tandem::tools::program_run {

/// The bytes of every resource, at its position in BuiltJob::resources.
using Contents = std::vector<std::vector<std::byte>>;

/// The type of a resource's bytes, and what it is called in front of a scalar's path.
program::ValueType type_of(const BuiltJob& built, const Resource& resource);

/// The files of --save. Throws Error for a resource that there is none of, and for an extension that does not fit.
/// @param contents are read when the files are written
std::vector<OutputFile> result_files(const BuiltJob& built, const std::vector<Setting>& saves,
                                     const Contents& contents);

/// The first lines of every resource that a shader writes.
std::string printed(const BuiltJob& built, const Contents& contents, std::size_t lines);

/// A resource on two devices.
struct ResourceComparison {
  std::size_t resource = 0;
  program::Comparison values;
};

/// Of every resource that a shader writes.
std::vector<ResourceComparison> compared(const BuiltJob& built, const Contents& a, const Contents& b,
                                         const program::Tolerance& tolerance);

/// A line for each resource, with the first and the worst value that differ.
std::string text_of(const BuiltJob& built, const std::vector<ResourceComparison>& comparisons,
                    const program::Tolerance& tolerance);

}  // namespace tandem::tools::program_run
