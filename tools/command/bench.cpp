#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/session/rendering.hpp"
#include "pathtracer/render/renderer.hpp"
#include "tools/command.hpp"
#include "tools/kernels/kernel.hpp"
#include "tools/kernels/kernel_run.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/report/bench_report.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/kernel_report.hpp"

namespace tandem::tools {
namespace {

struct Options {
  RenderOptions render;
  std::vector<std::string> devices;
  std::uint32_t rounds = 5;
  std::filesystem::path json;          ///< empty: none
  std::optional<std::string> kernels;  ///< in place of a scene: a list of names; "": all
};

template <typename Report>
int finish(const Options& options, const Report& report) {
  print("{}", table(report));
  if (!options.json.empty()) {
    const OutputFile file{options.json,
                          [&](const std::filesystem::path& path) { write_text(path, json_text(to_json(report))); }};
    write_or_rescue({&file, 1});
    print_written({&file, 1});
  }
  return exit_code::success;
}

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
  return finish(options, report);
}

int measure_kernels(const Options& options) {
  if (!options.json.empty()) check_output_path(options.json);
  const std::vector<kernels::Kernel> chosen = kernels::named_kernels(*options.kernels);
  std::vector<rhi::DeviceHandle> devices;
  KernelReport report{.threads = options.render.threads, .devices = {}, .kernels = {}};
  for (const std::string& name : options.devices) {
    devices.push_back(open_device(name, options.render));
    report.devices.push_back(devices.back()->info());
  }
  const Progress preparation = progress_bar("preparing kernels");
  std::vector<kernels::Problem> problems;
  for (const kernels::Kernel& kernel : chosen) problems.push_back(kernel.problem(kernels::Size::usual));
  std::vector<std::vector<kernels::KernelRun>> runs(chosen.size());  // of each kernel, on each device
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    report.kernels.push_back({.name = chosen[i].name, .description = chosen[i].description, .series = {}});
    for (const rhi::DeviceHandle& device : devices) {
      if (!preparation(static_cast<double>(i) / static_cast<double>(chosen.size()))) throw Cancelled();
      runs[i].emplace_back(device, chosen[i], problems[i]);
      report.kernels[i].series.push_back({.compile_milliseconds = runs[i].back().compile_milliseconds()});
    }
  }
  // As for a scene: round 0 warms up, and the devices take turns with each kernel.
  const Progress progress = progress_bar("kernels");
  for (std::uint32_t round = 0; round <= options.rounds; ++round) {
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (!progress(static_cast<double>(round) / (options.rounds + 1.0))) throw Cancelled();
      for (std::size_t index = 0; index < devices.size(); ++index) {
        try {
          const double milliseconds = runs[i][index].run();
          if (round > 0) report.kernels[i].series[index].milliseconds.push_back(milliseconds);
        } catch (const kernels::WrongAnswer& wrong) {
          print_error_line(wrong.what());
          return exit_code::failed;
        }
      }
    }
  }
  return finish(options, report);
}

/// Throws for options that say how to render a scene, which kernels have none of.
void refuse_scene_options(const CLI::App& command) {
  static constexpr const char* taken[] = {"--kernels", "--device", "--repeat", "--json", "--threads", "--validation"};
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const std::string name = option->get_name();
    if (std::ranges::find(taken, name) == std::end(taken))
      throw CLI::ValidationError("--kernels", name + " is about a scene, and no scene is rendered");
  }
  for (const CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; }))
    refuse_scene_options(*group);
}

}  // namespace

void add_bench_command(CLI::App& app, Action& action) {
  CLI::App* const command = app.add_subcommand(
      "bench", "Measure how fast devices render a scene or run compute kernels, in alternating runs");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, options->render);
  CLI::Option* const scene = command->get_option("SCENE")->required(false);
  std::string names;
  for (const kernels::Kernel& kernel : kernels::kernels())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", kernel.name);
  command
      ->add_option_function<std::vector<std::string>>(
          "--kernels",
          [options](const std::vector<std::string>& given) { options->kernels = given.empty() ? "" : given.front(); },
          "Measure compute kernels in place of a scene, and check their answers: all, or those of the list, of " +
              names)
      ->expected(0, 1)
      ->allow_extra_args(false)
      ->type_name("NAME,NAME,...");
  add_devices(*command, options->devices, "Devices to measure; the first is the reference of the ratios")->required();
  add_whole_number(*command, "--repeat", options->rounds, 1, 10'000, "Measured rounds, after one warm-up round");
  command->add_option("--json", options->json, "Write all measurements, round by round, as JSON")->type_name("FILE");
  command->footer(
      "Times are milliseconds on the device (by its timestamps where it has them), without loading and building.\n"
      "Exit code: 0 measured, 1 a kernel answered wrongly, 2 error.\n"
      "Examples:\n"
      "  tandem bench scenes/cornell_box.obj --device vulkan,cpu --repeat 9 --json bench.json\n"
      "  tandem bench --kernels --device vulkan,cpu,cpu-scalar\n"
      "  tandem bench --kernels fft,n-body --device vulkan,cpu");
  command->callback([&action, options, command, scene] {
    if (!options->kernels) {
      if (scene->count() == 0) throw CLI::RequiredError("SCENE");
      action = [options] { return measure_speed(*options); };
      return;
    }
    refuse_scene_options(*command);
    action = [options] { return measure_kernels(*options); };
  });
}

}  // namespace tandem::tools
