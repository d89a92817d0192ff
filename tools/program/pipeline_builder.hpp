#pragma once

#include <cstddef>
#include <cstdint>

#include "program/job/job.hpp"
#include "tools/program/loaded_program.hpp"

namespace tandem::tools::program_run {

/// A launch as a pipeline, yet without bindings, and the command that runs it.
struct LaunchPipeline {
  program::Pipeline pipeline;
  program::Command command;
  bool has_any_hit = false;
  std::uint32_t box_record = 0;  ///< the hit record of the first group with an intersection shader
};

/// Stages with their constants, push constants, shader records, and how much is run. Hit shaders without --hit are one
/// group, and with an intersection shader a second group for boxes. @param number of the launch, for the label
/// Throws Error, which begins with the option or the place in the job file.
LaunchPipeline make_pipeline(const LoadedProgram& program, const LoadedLaunch& loaded, const Launch& launch,
                             std::size_t number);

/// Sets the position of the command's pipeline.
void set_pipeline(program::Command& command, std::size_t position);

}  // namespace tandem::tools::program_run
