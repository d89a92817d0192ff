#pragma once

#include <string>
#include <vector>

#include "tools/program/loaded_program.hpp"

/// What shaders have to be given, for the user.
namespace tandem::tools::program_run {

/// An option that a run lacks, with a value that would do.
struct MissingOption {
  std::string what;    ///< for a sentence: "--buffer Words"
  std::string option;  ///< "--buffer Words=zeros:1024"
};

/// What the launches of the program need beyond the options; nothing where all is given. In the order of the bindings.
std::vector<MissingOption> missing_options(const LoadedProgram& program, const RunOptions& options);

/// Stages, bindings with their types, push constants with names and offsets, and specialisation constants, in lines.
std::string needs_text(const LoadedProgram& program);

/// The command line of the options of one launch with what is missing.
std::string proposed_command(const RunOptions& options, const std::vector<MissingOption>& missing);

/// Whether a launch binds a resource of this key to the binding: by its `bind`, else by the key itself.
std::optional<KeyMatch> binds(const Launch& launch, const Setting& resource, const NeededBinding& binding);

}  // namespace tandem::tools::program_run
