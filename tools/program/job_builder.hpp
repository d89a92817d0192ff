#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "program/job/job.hpp"
#include "tools/program/loaded_program.hpp"

namespace tandem::tools::program_run {

/// A buffer or an image of the job, as the user calls it.
struct Resource {
  std::string key;  ///< of the option that gave it
  bool is_image = false;
  std::size_t index = 0;    ///< in Job::buffers or Job::images
  bool is_written = false;  ///< by any shader
  std::string prefix;       ///< in front of a scalar's path: "result." of a block with an instance name
  std::vector<std::string> names;
};

struct BuiltJob {
  program::Job job;
  std::vector<Resource> resources;  ///< in the order of the bindings
};

/// The job that the options describe. Everything is given: missing_options() is empty. Throws Error, which begins with
/// the option or the place in the job file.
BuiltJob build_job(const LoadedProgram& program, const RunOptions& options);

}  // namespace tandem::tools::program_run
