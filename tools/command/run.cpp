#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "program/execute/execution.hpp"
#include "program/print/printing_job.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/program/job_builder.hpp"
#include "tools/program/needs.hpp"
#include "tools/program/printed_text.hpp"
#include "tools/program/results.hpp"
#include "tools/program/run_arguments.hpp"

namespace tandem::tools {
namespace {

using namespace program_run;

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
  for (const program::PrintCall& call : program::print_calls({.shaders = program.shaders}))
    print("  prints at {}: {}\n", call.place, shortened(call.source));
  const std::vector<MissingOption> missing = missing_options(program, options);
  if (options.launches.size() == 1)
    print("\n{}:\n  {}\n", missing.empty() ? "The command" : "For example", proposed_command(options, missing));
  return exit_code::success;
}

int check(const LoadedProgram& program, const RunOptions& options) {
  program::Job job;
  job.shaders = program.shaders;
  program::print_calls(job);  // throws where a format is wrong
  bool can_run = true;
  for (const std::string& name : options.devices) {
    const rhi::DeviceHandle device = open(name, options);
    const std::vector<std::string> reasons = program::refusals(*device, job);
    print("{}: {}\n", name, reasons.empty() ? "can run it" : "cannot run it");
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

/// Runs the commands one by one. Returns the milliseconds that the device needed.
/// @param text what the shaders print goes behind it
double run_printing(program::Execution& execution, const program::PrintingJob& printing, const std::string& name,
                    std::string& text) {
  double milliseconds = 0;
  for (const program::Command& command : printing.job.commands) {
    execution.set_buffer(printing.buffer, printing.job.buffers[printing.buffer].initial);
    milliseconds += execution.timed_run({&command, 1});
    text += printed_text(program::printed_lines(printing, execution.buffer(printing.buffer)), name + ": ");
  }
  return milliseconds;
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

int run_program(const RunArguments& given) {
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
  std::optional<program::PrintingJob> printing;
  if (options.print_lines > 0) printing = program::printing_job(built.job, options.print_lines);

  for (std::size_t i = 0; i < options.devices.size(); ++i) {
    if (interrupted()) throw Cancelled();
    const rhi::DeviceHandle device = open(options.devices[i], options);
    const std::string& name = options.devices[i];
    std::optional<ShownStage> stage("shaders for " + name);
    program::Execution execution(*device, printing ? printing->job : built.job);
    stage.emplace(name);
    std::string lines;
    const double milliseconds = printing ? run_printing(execution, *printing, name, lines) : execution.timed_run();
    contents[i] = contents_of(execution, built);
    stage.reset();
    print("{}{}: ran in {:.3f} ms\n", lines, name, milliseconds);
    if (options.time > 0 && printing) {
      program::Execution silent(*device, built.job);  // runs the shaders without their prints
      measure(silent, name, options.time);
    } else if (options.time > 0) {
      measure(execution, name, options.time);
    }
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

}  // namespace

void add_run_command(CLI::App& app, Action& action) {
  CLI::App* const command = app.add_subcommand("run", "Run a shader of your own on devices, and compare its results");
  const auto options = std::make_shared<RunArguments>();
  RunOptions& run = options->run;
  add_run_arguments(*command, *options);
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
  add_whole_number(*command, "--print-lines", run.print_lines, 0, 1u << 20,
                   "Lines of debugPrintfEXT to show of each launch at most; 0: the shaders run without printing");
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
