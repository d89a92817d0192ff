#include "tools/bench/measurement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <tuple>

#include "base/error.hpp"
#include "compare/session/rendering.hpp"
#include "pathtracer/render/path_recorder.hpp"
#include "pathtracer/render/renderer.hpp"
#include "tools/bench/first_picture.hpp"
#include "tools/options/job.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/progress_bar.hpp"

namespace tandem::tools {
namespace {

using Clock = std::chrono::steady_clock;

/// A scene on a device, in the form that a configuration asks for; several may share it.
struct Renderers {
  using Key = std::tuple<std::string, std::uint32_t, std::optional<pathtracer::TracingMode>>;
  std::map<Key, std::unique_ptr<pathtracer::Renderer>> made;

  pathtracer::Renderer& of(const std::string& device, const RenderOptions& options, const compare::Job& job) {
    std::unique_ptr<pathtracer::Renderer>& renderer = made[{device, options.threads, options.trace}];
    if (renderer == nullptr) {
      const rhi::DeviceHandle opened = open_device(device, options);
      const ShownStage stage(building_stage);
      renderer = std::make_unique<pathtracer::Renderer>(opened, job.scene, job.settings, options.trace);
      if (made.size() == 1) print_warnings(renderer->scene().warnings());
    }
    return *renderer;
  }
};

/// How the rays of the configuration's paths divide, by those of evenly spread paths.
RayShares ray_shares(pathtracer::Renderer& renderer, std::uint32_t samples) {
  constexpr std::uint64_t most_paths = 2048;
  const pathtracer::RenderSettings& settings = renderer.scene().settings();
  const std::uint64_t all = std::uint64_t{settings.width} * settings.height * samples;
  const std::uint64_t count = std::min(all, most_paths);
  std::vector<pathtracer::PathStart> starts;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t path = i * all / count, pixel = path / samples;
    starts.push_back({.path = {.pixel = {pixel % settings.width, pixel / settings.width},
                               .sample = static_cast<std::uint32_t>(path % samples)}});
  }
  RayShares shares{.paths = count, .is_complete = count == all};
  for (const pathtracer::PathEvents& events : record_paths(renderer.scene(), starts)) {
    bool is_first = true;
    for (const pathtracer::PathEvent& event : events) {
      if (event.kind() != pathtracer::EventKind::ray) continue;
      const auto kind = static_cast<pathtracer::RayKind>(event.words[pathtracer::event_word::ray_kind]);
      if (kind == pathtracer::RayKind::occlusion)
        ++shares.shadow;
      else
        ++(is_first ? shares.camera : shares.bounce);
      is_first = false;
    }
  }
  return shares;
}

/// The most memory that this program has had, in bytes.
std::uint64_t peak_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

BenchSeries series_of(const pathtracer::Renderer& renderer, const RenderOptions& options) {
  return {.device = renderer.scene().device().info(),
          .trace = renderer.scene().trace(),
          .threads = options.threads,
          .build_milliseconds = renderer.scene().build_milliseconds(),
          .structure_bytes = renderer.scene().structure_bytes(),
          .milliseconds = {}};
}

/// One picture, of which the times go to the series unless it only warms up.
void run_once(pathtracer::Renderer& renderer, const compare::Job& job, BenchSeries& series, std::uint32_t round,
              const std::string& label) {
  renderer.restart(job.settings);
  compare::compile(renderer, progress_bars());
  if (round == 0) series.compile_milliseconds = renderer.compile_milliseconds();
  const Clock::time_point start = Clock::now();
  if (!renderer.render(job.samples, progress_bar(label))) throw Cancelled();
  const std::chrono::duration<double, std::milli> taken = Clock::now() - start;
  series.rays = renderer.ray_count();
  if (round == 0) return;
  series.milliseconds.push_back(renderer.device_milliseconds());
  series.wall_milliseconds.push_back(taken.count());
}

/// Measures the configurations of one scene.
/// @param late devices whose first picture took too long; they are not tried again
void measure_scene(std::span<const Configuration> configurations, const MeasureOptions& options,
                   std::set<std::string>& late, BenchReport& report) {
  Renderers renderers;
  std::vector<compare::Job> jobs;
  std::vector<std::vector<pathtracer::Renderer*>> used;  // of each configuration, by device
  std::vector<BenchRun> runs;
  for (const Configuration& configuration : configurations) {
    jobs.push_back(load_job(configuration.options));
    const compare::Job& job = jobs.back();
    runs.push_back({.varied = configuration.varied, .job = summary(job), .series = {}});
    used.emplace_back();
    for (const std::string& device : options.devices) {
      if (late.contains(device)) continue;
      std::optional<double> first;
      if (options.first_picture_limit) {
        const ShownStage stage(fmt::format("first picture on {}", device));
        first = first_picture(configuration, device, *options.first_picture_limit);
        if (!first) {
          report.left_out.push_back(fmt::format(
              "{} from {} on: no picture within {:.0f} s; where a driver compiles shaders for long, it does so once",
              device, runs.back().job.scene, static_cast<double>(options.first_picture_limit->count()) / 1000));
          late.insert(device);
          continue;
        }
      }
      used.back().push_back(&renderers.of(device, configuration.options, job));
      runs.back().series.push_back(series_of(*used.back().back(), configuration.options));
      runs.back().series.back().first_picture_milliseconds = first;
    }
    // The scene is on the devices now, and the first job keeps it for those that come.
    if (jobs.size() > 1) jobs.back().scene = {};
  }
  // Round 0 warms up: first compilation, page faults, clock speeds.
  for (std::uint32_t round = 0; round <= options.rounds; ++round)
    for (std::size_t i = 0; i < jobs.size(); ++i)
      for (std::size_t device = 0; device < used[i].size(); ++device)
        run_once(*used[i][device], jobs[i], runs[i].series[device], round,
                 fmt::format("round {} of {}, {}", round, options.rounds, runs[i].series[device].device.name));
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    // Recording on Vulkan would compile another shader, for minutes; the paths are the same.
    const auto cpu = std::ranges::find_if(
        used[i], [](const pathtracer::Renderer* each) { return each->scene().device().info().backend == "cpu"; });
    if (cpu == used[i].end() || jobs[i].settings.integrator == pathtracer::Integrator::metropolis) continue;
    (*cpu)->restart(jobs[i].settings);
    runs[i].shares = ray_shares(**cpu, jobs[i].samples);
  }
  report.runs.insert(report.runs.end(), std::make_move_iterator(runs.begin()), std::make_move_iterator(runs.end()));
}

}  // namespace

BenchReport measure(std::span<const Configuration> configurations, const MeasureOptions& options) {
  BenchReport report{.rounds = options.rounds, .runs = {}};
  std::set<std::string> late;
  while (!configurations.empty()) {
    const auto other = std::ranges::find_if(configurations, [&](const Configuration& each) {
      return each.options.scene != configurations.front().options.scene;
    });
    const auto count = static_cast<std::size_t>(other - configurations.begin());
    measure_scene(configurations.first(count), options, late, report);
    configurations = configurations.subspan(count);
  }
  if (std::ranges::all_of(report.runs, [](const BenchRun& run) { return run.series.empty(); }))
    throw Error(fmt::format("nothing was measured: {}", fmt::join(report.left_out, "; ")));
  report.peak_bytes = peak_memory();
  return report;
}

}  // namespace tandem::tools
