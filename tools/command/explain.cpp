#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "base/error.hpp"
#include "compare/session/explanation.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/options/render_options.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/explanation_report.hpp"

namespace tandem::tools {
namespace {

struct Options {
  RenderOptions render;
  std::string a = "cpu";              ///< the first device, the reference
  std::string b = "vulkan";           ///< the second
  std::string arbiter = "cpu-exact";  ///< says which of two answers to a ray is right
  compare::ExplanationOptions explanation;
  bool all_events = false;
  std::filesystem::path json;  ///< empty: none
};

/// As explain would, but naming the options, and before devices are opened.
void check(const Options& options, const compare::Job& job) {
  const compare::ExplanationOptions& wanted = options.explanation;
  if (wanted.pixel.x >= job.settings.width || wanted.pixel.y >= job.settings.height)
    throw Error(fmt::format("--pixel {},{} is outside the image of {}x{} pixels", wanted.pixel.x, wanted.pixel.y,
                            job.settings.width, job.settings.height));
  if (wanted.sample && *wanted.sample >= job.samples)
    throw Error(fmt::format("--sample {} does not exist: the pixel has samples 0 to {} (--spp {})", *wanted.sample,
                            job.samples - 1, job.samples));
}

int run(const Options& options) {
  if (!options.json.empty()) check_output_path(options.json);
  const compare::Job job = load_job(options.render);
  check(options, job);
  compare::ExplanationOptions explanation_options = options.explanation;
  if (!explanation_options.trace_a) explanation_options.trace_a = options.render.trace;
  if (!explanation_options.trace_b) explanation_options.trace_b = options.render.trace;
  const compare::ComparedDevices devices{.a = open_device(options.a, options.render),
                                         .b = open_device(options.b, options.render),
                                         .arbiter = open_device(options.arbiter, options.render)};
  const StageProgress progress = progress_bars();
  progress("tracing paths on all devices", 0);
  const compare::Explanation explanation = explain(devices, job, explanation_options);
  progress("tracing paths on all devices", 1);
  print_warnings(explanation.warnings);
  print("{}", table(explanation, {.all_events = options.all_events, .colors = isatty(STDOUT_FILENO) != 0}));
  if (!options.json.empty()) {
    const OutputFile file{
        options.json, [&](const std::filesystem::path& path) { write_text(path, json_text(to_json(explanation))); }};
    write_or_rescue({&file, 1});
    print_written({&file, 1});
  }
  return explanation.mismatches() == 0 ? exit_code::success : exit_code::differ;
}

}  // namespace

void add_explain_command(CLI::App& app, Action& action) {
  CLI::App* const command =
      app.add_subcommand("explain", "Show where the paths of one pixel diverge between two devices, and why");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, options->render);
  compare::ExplanationOptions& explanation = options->explanation;
  add_pixel(*command, "--pixel", explanation.pixel, "The pixel; 0,0 is the upper left corner")->required();
  add_whole_number(*command, "--sample", explanation.sample, 0, 0xffffffffU,
                   "Compare and show only this sample [compare all, show the first that differs]");
  add_device_pair(*command, options->a, options->b);
  command->add_option("--arbiter", options->arbiter, "Device that decides which of two ray hits is right")
      ->type_name("D3")
      ->capture_default_str();
  add_tracing_mode(*command, "--trace-a", explanation.trace_a, "As --trace, for the first device only");
  add_tracing_mode(*command, "--trace-b", explanation.trace_b, "As --trace, for the second device only");
  command->add_flag("--all-events", options->all_events, "Show every field of every event, not only those that differ");
  command->add_flag_function(
      "--probe,!--no-probe", [options](std::int64_t count) { options->explanation.probe = count > 0; },
      "Also trace the rays of the path under masks, culling, transformed instances, ... [if the paths are equal]");
  command->add_option("--json", options->json, "Write all events and classes as JSON")->type_name("FILE");
  command->footer(
      "A shader of your own or an Amber script in the place of SCENE: 'tandem explain x.comp --help'.\n"
      "Exit code: 0 nothing but rounding and ties, 1 a mismatch: one of the devices is wrong, 2 error.\n"
      "Examples:\n"
      "  tandem explain scenes/cornell_box.obj --pixel 248,109 --a cpu --b vulkan\n"
      "  tandem explain scenes/foliage.obj --pixel 90,17 --sample 3 --a cpu --b vulkan --all-events --json path.json");
  command->callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace tandem::tools
