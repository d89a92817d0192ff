#pragma once

#include <filesystem>

#include "tools/program/run_options.hpp"

namespace tandem::tools::program_run {

/// Adds what a job file (docs/schema/job.schema.json) says to the options; files that it names are relative to its own
/// folder. Throws Error, naming the file and the place in it.
void read_job_file(const std::filesystem::path& path, RunOptions& options);

}  // namespace tandem::tools::program_run
