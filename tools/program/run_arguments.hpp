#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <vector>

#include "tools/program/run_options.hpp"

/// The options that say which shaders to run, and on what: those of every command that runs shaders of the user's.
namespace tandem::tools::program_run {

/// The options as they are read.
struct RunArguments {
  RunOptions run;
  Launch launch;              ///< of the command line
  std::filesystem::path job;  ///< empty: none
  bool non_opaque = false;
  double relative = 0;  ///< of the tolerance
};

/// SHADER, --job, -D, -I, --buffer and all that a launch needs. `arguments` outlives the parsing.
void add_run_arguments(CLI::App& command, RunArguments& arguments);

/// An option KEY=VALUE that may be given several times. `settings` outlives the parsing.
/// @param may_lack_key VALUE alone is taken
void add_settings(CLI::App& command, const char* option, std::vector<Setting>& settings, bool may_lack_key,
                  const char* type, const char* description);

/// The options with those of the job file, checked against each other. Throws Error.
RunOptions complete(const RunArguments& arguments);

}  // namespace tandem::tools::program_run
