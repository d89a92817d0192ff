#include "tools/program/explained_job.hpp"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "devices/devices.hpp"
#include "program/amber/script_run.hpp"
#include "rhi/glsl/compile.hpp"
#include "tools/output/messages.hpp"
#include "tools/program/loaded_program.hpp"
#include "tools/program/needs.hpp"

namespace tandem::tools::program_run {
namespace {

/// Every buffer and image, as if shaders wrote them all.
BuiltJob with_all_resources(program::Job job) {
  BuiltJob built{.job = std::move(job), .resources = {}};
  const auto add = [&](const std::string& name, bool is_image, std::size_t index) {
    built.resources.push_back(
        {.key = name, .is_image = is_image, .index = index, .is_written = true, .prefix = name, .names = {}});
  };
  for (std::size_t i = 0; i < built.job.buffers.size(); ++i) add(built.job.buffers[i].name, false, i);
  for (std::size_t i = 0; i < built.job.images.size(); ++i) add(built.job.images[i].desc.label, true, i);
  return built;
}

}  // namespace

bool is_program_file(std::string_view file) {
  const std::filesystem::path path(file);
  const std::string extension = path.extension().string();
  return extension == ".amber" || extension == ".spv" || extension == ".spvasm" || glsl::stage_of(path).has_value();
}

ExplainedJob explained_job(const RunArguments& arguments, const rhi::DeviceInfo& device) {
  const std::vector<std::filesystem::path>& files = arguments.launch.shaders;
  if (!files.empty() && files.front().extension() == ".amber") {
    if (files.size() > 1) throw Error(fmt::format("{}: one script is explained at a time", files[1].string()));
    program::amber::Script script = program::amber::read(files.front());
    if (!script.unsupported.empty()) throw Error(fmt::format("{}: {}", files.front().string(), script.unsupported));
    program::amber::compile(script, true);
    program::amber::adapt(script, device);
    return {files.front().string(), with_all_resources(std::move(script.job))};
  }
  RunOptions options = complete(arguments);
  options.debug_info = true;
  const LoadedProgram program = load_program(options);
  if (const std::vector<MissingOption> missing = missing_options(program, options); !missing.empty()) {
    std::string names;
    for (const MissingOption& each : missing) names += (names.empty() ? "" : ", ") + each.what;
    throw Error(
        fmt::format("the shaders need more than is given: {}; 'tandem run' with the same options proposes a "
                    "command",
                    names));
  }
  return {program.shaders.front().name, build_job(program, options)};
}

namespace {

rhi::DeviceDesc device_desc(const std::string& name, const RunOptions& options) {
  rhi::DeviceDesc desc;
  desc.name = name;
  desc.driver_validation = options.validation;
  desc.on_message = print_message;
  desc.thread_count = options.threads;
  return desc;
}

}  // namespace

rhi::DeviceHandle open_device(const std::string& name, const RunOptions& options) {
  return create_device(device_desc(name, options));
}

rhi::DeviceHandle open_recording_device(const std::string& name, const RunOptions& options) {
  rhi::DeviceDesc desc = device_desc(name == "cpu" ? "cpu-scalar" : name, options);
  desc.quick_kernels = true;
  return create_device(desc);
}

std::array<std::uint32_t, 3> invocation_of(const char* option, const std::string& text) {
  std::array<std::uint32_t, 3> id = {};
  const char* next = text.data();
  const char* const end = next + text.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [rest, error] = std::from_chars(next, end, id[axis]);
    if (error != std::errc() || (rest != end && (*rest != ',' || axis == 2)))
      throw CLI::ValidationError(option, fmt::format("'{}' is not of the form X[,Y[,Z]]", shortened(text)));
    if (rest == end) return id;
    next = rest + 1;
  }
  return id;
}

}  // namespace tandem::tools::program_run
