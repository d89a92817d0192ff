#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "compare/session/rendering.hpp"
#include "pathtracer/render/renderer.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/report/bench_report.hpp"
#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

struct Options {
  RenderOptions render;
  std::vector<std::string> devices;
  std::uint32_t rounds = 5;
  std::filesystem::path json;  ///< empty: none
};

int measure_speed(const Options& options) {
  if (!options.json.empty()) check_output_path(options.json);
  const compare::Job job = load_job(options.render);
  BenchReport report{.job = summary(job), .threads = options.render.threads, .series = {}};
  std::vector<std::unique_ptr<pathtracer::Renderer>> renderers;
  for (const std::string& name : options.devices) {
    const rhi::DeviceHandle device = open_device(name, options.render);
    const ShownStage stage(building_stage);
    renderers.push_back(std::make_unique<pathtracer::Renderer>(device, job.scene, job.settings, options.render.trace));
    report.series.push_back({.device = device->info(),
                             .trace = renderers.back()->scene().trace(),
                             .build_milliseconds = renderers.back()->scene().build_milliseconds(),
                             .milliseconds = {}});
  }
  print_warnings(renderers.front()->scene().warnings());

  // Round 0 warms up: first compilation, page faults, clock speeds. The devices take turns within a round, so that a
  // machine that becomes slower or faster does so for all of them.
  for (std::uint32_t round = 0; round <= options.rounds; ++round) {
    for (std::size_t index = 0; index < renderers.size(); ++index) {
      pathtracer::Renderer& renderer = *renderers[index];
      BenchSeries& series = report.series[index];
      renderer.restart(job.settings);
      compare::compile(renderer, progress_bars());
      if (round == 0) series.compile_milliseconds = renderer.compile_milliseconds();
      const std::string label = fmt::format("round {} of {}, {}", round, options.rounds, series.device.name);
      if (!renderer.render(job.samples, progress_bar(label))) throw Cancelled();
      series.rays = renderer.ray_count();
      if (round > 0) series.milliseconds.push_back(renderer.device_milliseconds());
    }
  }
  print("{}", table(report));
  if (!options.json.empty()) {
    const OutputFile file{options.json,
                          [&](const std::filesystem::path& path) { write_text(path, json_text(to_json(report))); }};
    write_or_rescue({&file, 1});
    print_written({&file, 1});
  }
  return exit_code::success;
}

}  // namespace

void add_bench_command(CLI::App& app, Action& action) {
  CLI::App* const command = app.add_subcommand("bench", "Measure how fast devices render a scene, in alternating runs");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, options->render);
  add_devices(*command, options->devices, "Devices to measure; the first is the reference of the ratios")->required();
  add_whole_number(*command, "--repeat", options->rounds, 1, 10'000, "Measured rounds, after one warm-up round");
  command->add_option("--json", options->json, "Write all measurements, round by round, as JSON")->type_name("FILE");
  command->footer(
      "Times are milliseconds on the device (by its timestamps where it has them), without loading and building.\n"
      "Example:\n"
      "  tandem bench scenes/cornell_box.obj --device vulkan,cpu --repeat 9 --json bench.json");
  command->callback([&action, options] { action = [options] { return measure_speed(*options); }; });
}

}  // namespace tandem::tools
