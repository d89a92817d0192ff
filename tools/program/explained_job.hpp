#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "rhi/device.hpp"
#include "tools/program/job_builder.hpp"
#include "tools/program/run_arguments.hpp"

namespace tandem::tools::program_run {

/// What two devices are compared on: an Amber script, or shaders with the options of `tandem run`.
struct ExplainedJob {
  std::string name;  ///< of the script, or the first shader
  BuiltJob built;    ///< its shaders have names and line numbers where they are GLSL
};

/// Whether a file name is that of something that `tandem run` or `tandem amber` takes.
bool is_program_file(std::string_view file);

/// @param device whose limits a script may depend on
/// Throws Error and rhi::Error, with the file or option at fault.
ExplainedJob explained_job(const RunArguments& arguments, const rhi::DeviceInfo& device);

/// A device with the options of the run.
rhi::DeviceHandle open_device(const std::string& name, const RunOptions& options);

/// Such a device for recording, whose kernels are large and run few times: the C++ compiler takes little time over them
/// (DeviceDesc::quick_kernels), and "cpu" has one lane, which takes a tenth of the time of several. Results are the
/// same.
rhi::DeviceHandle open_recording_device(const std::string& name, const RunOptions& options);

/// "5", "5,2" or "5,2,0". Throws CLI::ValidationError, naming the option.
std::array<std::uint32_t, 3> invocation_of(const char* option, const std::string& text);

}  // namespace tandem::tools::program_run
