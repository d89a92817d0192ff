#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "program/execute/execution.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/program/job_builder.hpp"
#include "tools/program/job_file.hpp"
#include "tools/program/needs.hpp"
#include "tools/program/results.hpp"

namespace tandem::tools {
namespace {

using namespace program_run;

/// The options as they are read.
struct Options {
  RunOptions run;
  Launch launch;              ///< of the command line
  std::filesystem::path job;  ///< empty: none
  bool non_opaque = false;
  double relative = 0;
};

/// A name or place, without the value: "KEY=VALUE".
Setting key_and_value(const char* option, const std::string& text, bool may_lack_key = false) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    if (may_lack_key && equals != 0) return {.where = option, .key = {}, .value = text};
    throw CLI::ValidationError(option, fmt::format("'{}' is not of the form KEY=VALUE", shortened(text)));
  }
  return {.where = option, .key = text.substr(0, equals), .value = text.substr(equals + 1)};
}

/// An option that may be given several times.
void add_settings(CLI::App& command, const char* option, std::vector<Setting>& settings, bool may_lack_key,
                  const char* type, const char* description) {
  const auto read = [option, may_lack_key, &settings](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) settings.push_back(key_and_value(option, text, may_lack_key));
  };
  command.add_option_function<std::vector<std::string>>(option, read, description)
      ->allow_extra_args(false)
      ->type_name(type);
}

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

RunOptions complete(const Options& given) {
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

rhi::DeviceHandle open(const std::string& name, const RunOptions& options) {
  RenderOptions execution;
  execution.threads = options.threads;
  execution.validation = options.validation;
  return open_device(name, execution);
}

/// Prints what the shaders need beyond the options, and throws.
[[noreturn]] void propose(const LoadedProgram& program, const RunOptions& options,
                          const std::vector<MissingOption>& missing) {
  print("{}", needs_text(program));
  if (options.launches.size() == 1) print("\nFor example:\n  {}\n", proposed_command(options, missing));
  std::string names;
  for (const MissingOption& each : missing) names += (names.empty() ? "" : ", ") + each.what;
  throw Error("the shaders need more than is given: " + names);
}

int list(const LoadedProgram& program, const RunOptions& options) {
  print("{}", needs_text(program));
  const std::vector<MissingOption> missing = missing_options(program, options);
  if (options.launches.size() == 1)
    print("\n{}:\n  {}\n", missing.empty() ? "The command" : "For example", proposed_command(options, missing));
  return exit_code::success;
}

int check(const LoadedProgram& program, const RunOptions& options) {
  program::Job job;
  job.shaders = program.shaders;
  bool can_run = true;
  for (const std::string& name : options.devices) {
    const rhi::DeviceHandle device = open(name, options);
    const std::vector<std::string> reasons = program::refusals(*device, job);
    print("{}: {}\n", device->info().name, reasons.empty() ? "can run it" : "cannot run it");
    for (const std::string& reason : reasons) print("  {}\n", reason);
    can_run = can_run && reasons.empty();
  }
  return can_run ? exit_code::success : exit_code::failed;
}

Contents contents_of(program::Execution& execution, const BuiltJob& built) {
  Contents contents;
  for (const Resource& resource : built.resources)
    contents.push_back(resource.is_image ? execution.image(resource.index) : execution.buffer(resource.index));
  return contents;
}

void measure(program::Execution& execution, const std::string& name, std::uint32_t runs) {
  std::vector<double> times;
  for (std::uint32_t i = 0; i < runs; ++i) {
    if (interrupted()) throw Cancelled();
    times.push_back(execution.timed_run());
  }
  std::ranges::sort(times);
  print("{}: median {:.3f} ms of {} {}, {:.3f} to {:.3f}\n", name, times[times.size() / 2], runs,
        runs == 1 ? "run" : "runs", times.front(), times.back());
}

int run_program(const Options& given) {
  const RunOptions options = complete(given);
  const LoadedProgram program = load_program(options);
  if (options.list) return list(program, options);
  if (options.check) return check(program, options);
  if (const std::vector<MissingOption> missing = missing_options(program, options); !missing.empty())
    propose(program, options, missing);
  const BuiltJob built = build_job(program, options);
  std::vector<Contents> contents(options.devices.size());
  const std::vector<OutputFile> files = result_files(built, options.saves, contents.front());
  check_output_files(files);

  for (std::size_t i = 0; i < options.devices.size(); ++i) {
    if (interrupted()) throw Cancelled();
    const rhi::DeviceHandle device = open(options.devices[i], options);
    const std::string& name = device->info().name;
    std::optional<ShownStage> stage("shaders for " + name);
    program::Execution execution(*device, built.job);
    stage.emplace(name);
    const double milliseconds = execution.timed_run();
    contents[i] = contents_of(execution, built);
    stage.reset();
    print("{}: ran in {:.3f} ms\n", name, milliseconds);
    if (options.time > 0) measure(execution, name, options.time);
  }
  if (options.print) print("{}", printed(built, contents.front(), options.lines));
  write_or_rescue(files);
  print_written(files);
  if (!options.compare) return exit_code::success;
  bool agree = true;
  for (std::size_t i = 1; i < options.devices.size(); ++i) {
    const std::vector<ResourceComparison> comparisons =
        compared(built, contents.front(), contents[i], options.tolerance);
    const bool pair_agrees =
        std::ranges::all_of(comparisons, [](const ResourceComparison& each) { return each.values.agrees(); });
    print("{} against {}: {}\n{}", options.devices.front(), options.devices[i], pair_agrees ? "agree" : "differ",
          text_of(built, comparisons, options.tolerance));
    agree = agree && pair_agrees;
  }
  return agree ? exit_code::success : exit_code::differ;
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

void add_run_command(CLI::App& app, Action& action) {
  CLI::App* const command = app.add_subcommand("run", "Run a shader of your own on devices, and compare its results");
  const auto options = std::make_shared<Options>();
  RunOptions& run = options->run;
  command
      ->add_option("SHADER", options->launch.shaders,
                   "GLSL (.comp; or .rgen with .rmiss, .rchit, .rahit, .rint, .rcall), SPIR-V (.spv) or its text "
                   "(.spvasm)")
      ->type_name("FILE");
  command->add_option("--job", options->job, "Several launches, with what they are bound to, in place of SHADER")
      ->type_name("FILE.json");
  const auto define = [&run](const std::vector<std::string>& texts) {
    for (const std::string& text : texts)
      run.defines.push_back({text.substr(0, text.find('=')),
                             text.find('=') == std::string::npos ? "1" : text.substr(text.find('=') + 1)});
  };
  command->add_option_function<std::vector<std::string>>("-D", define, "Define a macro of the GLSL; 1 without a value")
      ->allow_extra_args(false)
      ->type_name("NAME[=VALUE]");
  command->add_option("-I", run.include_directories, "Folder to search for #include \"...\"")
      ->allow_extra_args(false)
      ->type_name("DIR");
  add_resource_options(*command, run);
  command->add_flag("--non-opaque", options->non_opaque,
                    "Rays of queries see candidates on the scene, as they do where an any-hit shader is given");
  add_launch_options(*command, options->launch);
  add_devices(*command, run.devices, "Devices to run on")->capture_default_str();
  command->add_flag("--compare", run.compare, "Compare what the shaders write on the first device and on each other");
  add_whole_number(*command, "--ulp", run.tolerance.ulp, 0, 1u << 31,
                   "Units in the last place by which two numbers may differ; of whole numbers their difference");
  add_number(*command, "--tolerance", options->relative, 0, 1, "Relative difference that is accepted as well");
  add_settings(*command, "--save", run.saves, false, "KEY=FILE",
               "Write a resource of the first device: .bin, .raw, .npy, .csv or .txt, an image also .png or .exr");
  command->add_flag("--print", run.print, "Print what the shaders have written on the first device");
  add_whole_number(*command, "--lines", run.lines, 1, 1u << 20, "Lines of each resource that --print prints");
  command->add_flag("--list", run.list, "List bindings, push constants and specialisation constants; run nothing");
  command->add_flag("--check", run.check, "Say why each device cannot run the shaders, if so; compile and run nothing");
  add_whole_number(*command, "--time", run.time, 0, 1u << 20, "Runs to measure after the first");
  add_whole_number(*command, "--threads", run.threads, 0, 1024,
                   "Worker threads of the CPU devices; 0: one per hardware thread");
  command->add_flag("--validation", run.validation,
                    "Enable the Vulkan validation layers; their messages go to standard error");
  command->footer(
      "Without all that the shader needs, this lists it and proposes a command.\n"
      "Exit code: 0 success, or the results agree; 1 they differ beyond --ulp and --tolerance, or --check found a\n"
      "device that cannot run it; 2 error.\n"
      "Examples:\n"
      "  tandem run scale.comp --list\n"
      "  tandem run scale.comp --buffer values=iota:1024 --push factor=2 --groups 16 --print\n"
      "  tandem run scale.comp --buffer values=in.npy --push 2 --size 1024 --device cpu,vulkan --compare --ulp 4\n"
      "  tandem run a.rgen a.rmiss a.rchit --scene model.obj --image picture=512x512 --size 512x512 --save "
      "picture=a.png");
  command->callback([&action, options] { action = [options] { return run_program(*options); }; });
}

}  // namespace tandem::tools
