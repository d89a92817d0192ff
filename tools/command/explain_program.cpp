#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "program/explain/explanation.hpp"
#include "program/explain/text.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/program/explained_job.hpp"
#include "tools/program/explanation_json.hpp"
#include "tools/program/run_arguments.hpp"
#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

using namespace program_run;

struct Options {
  RunArguments run;
  std::string a = "cpu", b = "vulkan", arbiter = "cpu-exact";
  std::optional<std::array<std::uint32_t, 3>> invocation;
  std::optional<std::uint32_t> command;
  std::uint32_t most_invocations = 4096;
  std::uint32_t most_mebibytes = 256;
  bool skip_order = false;
  std::filesystem::path json;  ///< empty: none
};

int explain_program(const Options& options) {
  if (!options.json.empty()) check_output_path(options.json);
  const RunOptions& run = options.run.run;
  const rhi::DeviceHandle a = open_recording_device(options.a, run);
  const rhi::DeviceHandle b = open_recording_device(options.b, run);
  const ExplainedJob explained = explained_job(options.run, a->info());
  program::ExplainOptions wanted{.invocation = options.invocation,
                                 .most_bytes = std::uint64_t{options.most_mebibytes} << 20,
                                 .most_invocations = options.most_invocations,
                                 .check_order = !options.skip_order};
  if (options.command) {
    if (*options.command == 0 || *options.command > explained.built.job.commands.size())
      throw Error(fmt::format("--command {}: there are commands 1 to {}", *options.command,
                              explained.built.job.commands.size()));
    wanted.command = *options.command - 1;
  }
  rhi::DeviceHandle exact;
  if (!explained.built.job.top_levels.empty()) exact = open_device(options.arbiter, run);
  wanted.exact = exact.get();
  std::optional<ShownStage> stage("recording on both devices");
  const program::Explanation explanation = program::explain(*a, *b, explained.built.job, wanted);
  stage.reset();
  const program::ExplanationNames names{.a = a->info().name, .b = b->info().name, .input = explained.name};
  print("{}", program::explanation_text(explanation, explained.built.job, names));
  if (!options.json.empty()) {
    const OutputFile file{options.json, [&](const std::filesystem::path& path) {
                            write_text(path, json_text(to_json(explanation, explained.built.job, names)));
                          }};
    write_or_rescue({&file, 1});
    print_written({&file, 1});
  }
  return program::gravest(explanation) == program::Cause::mismatch ? exit_code::differ : exit_code::success;
}

}  // namespace

void add_program_explain_command(CLI::App& app, Action& action) {
  CLI::App* const command = app.add_subcommand(
      "explain", "Name the first instruction of a shader whose result differs between two devices, and why");
  const auto options = std::make_shared<Options>();
  add_run_arguments(*command, options->run);
  add_device_pair(*command, options->a, options->b);
  command->add_option("--arbiter", options->arbiter, "Device that decides which of two ray hits is right")
      ->type_name("D3")
      ->capture_default_str();
  command
      ->add_option_function<std::string>(
          "--invocation",
          [options](const std::string& text) { options->invocation = invocation_of("--invocation", text); },
          "The only invocation to look at: gl_GlobalInvocationID, or gl_LaunchIDEXT")
      ->type_name("X[,Y[,Z]]");
  add_whole_number(*command, "--command", options->command, 1, 1u << 20,
                   "The dispatch or trace to explain, counted with copies [the first that differs]");
  add_whole_number(*command, "--invocations", options->most_invocations, 1, 1u << 20,
                   "Invocations to record at most, of those that compute other bits");
  add_whole_number(*command, "--memory", options->most_mebibytes, 1, 4095, "Size of the recordings at most, in MiB");
  command->add_option("--json", options->json, "Write what differs, with its classes, as JSON")->type_name("FILE");
  command->add_flag("--no-order", options->skip_order,
                    "Do not run the launch backwards to find what depends on the order of invocations");
  add_whole_number(*command, "--threads", options->run.run.threads, 0, 1024,
                   "Worker threads of the CPU devices; 0: one per hardware thread");
  command->add_flag("--validation", options->run.run.validation,
                    "Enable the Vulkan validation layers; their messages go to standard error");
  command->footer(
      "SHADER may also be one Amber script (FILE.amber).\n"
      "Exit code: 0 no mismatch, 1 a mismatch: one of the devices is wrong, 2 error.\n"
      "Examples:\n"
      "  tandem explain scale.comp --buffer values=iota:1024 --push factor=2 --groups 16 --a cpu --b vulkan\n"
      "  tandem explain shadow.amber --invocation 5,2 --a cpu --b vulkan:1");
  command->callback([&action, options] { action = [options] { return explain_program(*options); }; });
}

}  // namespace tandem::tools
