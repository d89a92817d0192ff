#include "tools/program/run_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "tools/options/option_values.hpp"
#include "tools/program/job_file.hpp"

namespace tandem::tools::program_run {
namespace {

/// A name or place, without the value: "KEY=VALUE".
Setting key_and_value(const char* option, const std::string& text, bool may_lack_key = false) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    if (may_lack_key && equals != 0) return {.where = option, .key = {}, .value = text};
    throw CLI::ValidationError(option, fmt::format("'{}' is not of the form KEY=VALUE", shortened(text)));
  }
  return {.where = option, .key = text.substr(0, equals), .value = text.substr(equals + 1)};
}

}  // namespace

void add_settings(CLI::App& command, const char* option, std::vector<Setting>& settings, bool may_lack_key,
                  const char* type, const char* description) {
  const auto read = [option, may_lack_key, &settings](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) settings.push_back(key_and_value(option, text, may_lack_key));
  };
  command.add_option_function<std::vector<std::string>>(option, read, description)
      ->allow_extra_args(false)
      ->type_name(type);
}

namespace {

/// Settings of the command line go before those of the job file, of the same key in their place.
void merge(std::vector<Setting>& own, const std::vector<Setting>& of_file) {
  const std::size_t count = own.size();
  for (const Setting& setting : of_file)
    if (std::none_of(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(count),
                     [&](const Setting& each) { return each.key == setting.key; }))
      own.push_back(setting);
}

void refuse_repeated(const std::vector<Setting>& settings) {
  for (std::size_t i = 0; i < settings.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (settings[i].key == settings[j].key)
        throw Error(fmt::format("{}: '{}' is given twice", settings[i].where, shortened(settings[i].key)));
}

void add_resource_options(CLI::App& command, RunOptions& run) {
  add_settings(
      command, "--buffer", run.buffers, false, "KEY=CONTENTS",
      "A buffer. KEY: SET:BINDING, or the name of the block, of its instance or of its only member, with [N] "
      "of an array. CONTENTS: zeros, iota, random:SEED[:A..B], a list of numbers, or a file (.bin, .raw, .npy, "
      ".csv, .txt); then :N elements or :SIZE (4MiB), and :TYPE (float, uvec2) where the shader's does not say "
      "what the bytes are");
  add_settings(command, "--image", run.images, false, "KEY=WORDS",
               "An image: FORMAT (rgba8, r32f), SIZE (512x512, 64x64x8), levels=N and CONTENTS as of a buffer or a "
               "picture, separated by colons; the shader's format unless one is named");
  add_settings(command, "--sampler", run.samplers, true, "[KEY=]WORDS",
               "A sampler: linear or nearest; repeat, mirror, clamp or border; less, greater, ... to compare; without "
               "KEY every one. Without this option nearest,repeat");
  add_settings(command, "--scene", run.scenes, true, "[KEY=]FILE",
               "An acceleration structure: the triangles, and the spheres as boxes, of an OBJ file, a glTF file or a "
               "scene description");
}

void add_launch_options(CLI::App& command, Launch& launch) {
  add_settings(command, "--spec", launch.specialization, false, "ID=VALUE", "A specialisation constant, by id or name");
  add_settings(command, "--push", launch.push, true, "[NAME=]VALUES",
               "Push constants: those of a member, or all of them in their order. What is not given is 0");
  add_settings(command, "--record", launch.records, false, "RECORD=VALUES",
               "What a shader reads as its shaderRecordEXT block: rgen, miss:0, hit:0 or callable:0");
  add_settings(command, "--hit", launch.hit_groups, true, "FILE,FILE,...",
               "A hit group: closest-hit, any-hit and intersection shader; repeated, record 0, 1, ... Without it the "
               "hit shaders among SHADER are one group, and with an intersection shader a second one for boxes");
  command.add_option("--entry", launch.entry_point, "The entry point of a SPIR-V module that has several")
      ->type_name("NAME");
  add_whole_number(command, "--recursion", launch.max_recursion_depth, 1, 31,
                   "Rays in flight at once, where a hit or miss shader traces");
  const auto size = [](const char* option, std::optional<Setting>& target) {
    return [option, &target](const std::string& text) { target = Setting{.where = option, .key = {}, .value = text}; };
  };
  command.add_option_function<std::string>("--groups", size("--groups", launch.groups), "Workgroups to run")
      ->type_name("X[,Y[,Z]]");
  command
      .add_option_function<std::string>("--size", size("--size", launch.size),
                                        "Rays to trace; of a compute shader, invocations, in whole workgroups")
      ->type_name("X[,Y[,Z]]");
}

}  // namespace

RunOptions complete(const RunArguments& given) {
  RunOptions options = given.run;
  options.is_opaque = !given.non_opaque;
  options.tolerance.relative = given.relative;
  if (given.job.empty()) {
    if (given.launch.shaders.empty()) throw Error("SHADER is required, or --job");
    options.launches = {given.launch};
  } else {
    if (!given.launch.shaders.empty()) throw Error("--job: the shaders are those of the file; none is given beside it");
    RunOptions file;
    read_job_file(given.job, file);
    options.launches = file.launches;
    options.is_opaque = options.is_opaque && file.is_opaque;
    merge(options.buffers, file.buffers);
    merge(options.images, file.images);
    merge(options.samplers, file.samplers);
    merge(options.scenes, file.scenes);
    merge(options.saves, file.saves);
    options.defines.insert(options.defines.begin(), file.defines.begin(), file.defines.end());
    options.include_directories.insert(options.include_directories.end(), file.include_directories.begin(),
                                       file.include_directories.end());
  }
  refuse_repeated(options.buffers);
  refuse_repeated(options.images);
  refuse_repeated(options.samplers);
  refuse_repeated(options.scenes);
  if (options.compare && options.devices.size() < 2)
    throw Error("--compare: two devices are compared, as in --device cpu,vulkan");
  return options;
}

void add_run_arguments(CLI::App& command, RunArguments& arguments) {
  RunOptions& run = arguments.run;
  command
      .add_option("SHADER", arguments.launch.shaders,
                  "GLSL (.comp; or .rgen with .rmiss, .rchit, .rahit, .rint, .rcall), SPIR-V (.spv) or its text "
                  "(.spvasm)")
      ->type_name("FILE");
  command.add_option("--job", arguments.job, "Several launches, with what they are bound to, in place of SHADER")
      ->type_name("FILE.json");
  const auto define = [&run](const std::vector<std::string>& texts) {
    for (const std::string& text : texts)
      run.defines.push_back({text.substr(0, text.find('=')),
                             text.find('=') == std::string::npos ? "1" : text.substr(text.find('=') + 1)});
  };
  command.add_option_function<std::vector<std::string>>("-D", define, "Define a macro of the GLSL; 1 without a value")
      ->allow_extra_args(false)
      ->type_name("NAME[=VALUE]");
  command.add_option("-I", run.include_directories, "Folder to search for #include \"...\"")
      ->allow_extra_args(false)
      ->type_name("DIR");
  add_resource_options(command, run);
  command.add_flag("--non-opaque", arguments.non_opaque,
                   "Rays of queries see candidates on the scene, as they do where an any-hit shader is given");
  add_launch_options(command, arguments.launch);
}

}  // namespace tandem::tools::program_run
