#include "tools/report/bench_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tools/report/device_json.hpp"
#include "tools/report/interval.hpp"
#include "tools/report/job_report.hpp"
#include "tools/report/speed.hpp"
#include "tools/report/spread.hpp"

namespace tandem::tools {
namespace {

/// Of bench.json: 2 has several runs.
constexpr int bench_format = 2;

/// Interquartile range over median from which a series is called noisy.
constexpr double noisy = 0.1;

double camera_paths(const compare::JobSummary& job) {
  return static_cast<double>(job.settings.width) * job.settings.height * job.samples;
}

std::string run_text(const BenchRun& run) {
  std::string text;
  for (const auto& [option, value] : run.varied)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", option, value);
  return text;
}

nlohmann::ordered_json to_json(const MedianInterval& interval) {
  return {{"median", interval.median},
          {"least", interval.least},
          {"most", interval.most},
          {"confidence", interval.confidence}};
}

/// A field of CSV (RFC 4180).
std::string field(std::string_view text) {
  if (text.find_first_of(",\"\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char each : text) {
    if (each == '"') quoted += '"';
    quoted += each;
  }
  return quoted + '"';
}

}  // namespace

std::vector<std::string> noise_warnings(const BenchReport& report) {
  std::vector<std::string> warnings;
  for (const BenchRun& run : report.runs)
    for (const BenchSeries& series : run.series)
      if (const double noise = relative_noise(series.milliseconds); noise > noisy)
        warnings.push_back(
            fmt::format("{}{}{} on {}: half of the times scatter by more than {:.0f} % of their median; "
                        "ratios closer to 1 than that say nothing",
                        run.job.scene, run.varied.empty() ? "" : ", ", run_text(run), series.device.name, 100 * noise));
  return warnings;
}

std::string table(const BenchReport& report) {
  std::string text;
  const auto put = [&](fmt::string_view format, const auto&... cells) {
    fmt::vformat_to(std::back_inserter(text), format, fmt::make_format_args(cells...));
  };
  const auto row = [&](const auto&... cells) { put("{:<12}{:<30}{:>12}{:>14}  {}\n", cells...); };
  for (const BenchRun& run : report.runs) {
    put("{}, {}: {} rounds after one to warm up\n", scene_text(run.job), settings_text(run.job), report.rounds);
    if (!run.varied.empty()) put("with {}\n", run_text(run));
    text += '\n';
    if (run.series.empty()) {
      text += "no device was measured\n\n";
      continue;
    }
    row("device", "ms (min, max)", "Mrays/s", "Msamples/s", "times the first device's speed (interval)");
    for (const BenchSeries& series : run.series) {
      const Spread times = spread(series.milliseconds);
      const MedianInterval ratio = ratio_interval(run.series.front().milliseconds, series.milliseconds);
      row(series.device.name, fmt::format("{:.1f} ({:.1f}, {:.1f})", times.median, times.least, times.most),
          fmt::format("{:.3f}", per_second_in_millions(static_cast<double>(series.rays), times.median)),
          fmt::format("{:.3f}", per_second_in_millions(camera_paths(run.job), times.median)),
          fmt::format("{:.3f} ({:.3f}, {:.3f} at {:.0f} %)", ratio.median, ratio.least, ratio.most,
                      100 * ratio.confidence));
    }
    text += '\n';
    for (const BenchSeries& series : run.series) {
      put("{:<12}{}, {}, trace {}, structures of {:.1f} MiB built in {:.1f} ms, shaders compiled in {:.1f} s",
          series.device.name, series.device.description, series.device.driver, pathtracer::name(series.trace),
          static_cast<double>(series.structure_bytes) / (1 << 20), series.build_milliseconds,
          series.compile_milliseconds / 1000);
      if (series.first_picture_milliseconds)
        put(", first picture of one sample after {:.2f} s", *series.first_picture_milliseconds / 1000);
      text += '\n';
    }
    if (run.shares) {
      const double paths = static_cast<double>(run.shares->paths);
      put("rays of a path: {:.2f} from the camera, {:.2f} bounced, {:.2f} to lights ({} paths{})\n",
          static_cast<double>(run.shares->camera) / paths, static_cast<double>(run.shares->bounce) / paths,
          static_cast<double>(run.shares->shadow) / paths, run.shares->paths, run.shares->is_complete ? ", all" : "");
    }
    text += '\n';
  }
  put("Memory: at most {:.0f} MiB.\n", static_cast<double>(report.peak_bytes) / (1 << 20));
  for (const std::string& sentence : report.left_out) put("Left out: {}.\n", sentence);
  for (const std::string& sentence : noise_warnings(report)) put("Noisy: {}.\n", sentence);
  return text;
}

nlohmann::ordered_json to_json(const BenchReport& report) {
  nlohmann::ordered_json json;
  json["rounds"] = report.rounds;
  json["runs"] = nlohmann::ordered_json::array();
  for (const BenchRun& run : report.runs) {
    nlohmann::ordered_json entry;
    entry["varied"] = nlohmann::ordered_json::object();
    for (const auto& [option, value] : run.varied) entry["varied"][option] = value;
    entry["settings"] = to_json(run.job);
    if (run.shares)
      entry["recorded_paths"] = {{"paths", run.shares->paths},
                                 {"complete", run.shares->is_complete},
                                 {"camera_rays", run.shares->camera},
                                 {"bounced_rays", run.shares->bounce},
                                 {"shadow_rays", run.shares->shadow}};
    entry["devices"] = nlohmann::ordered_json::array();
    for (const BenchSeries& series : run.series) {
      const Spread times = spread(series.milliseconds);
      nlohmann::ordered_json device = to_json(series.device);
      device["trace"] = pathtracer::name(series.trace);
      device["threads"] = series.threads;
      device["ms"] = to_json(times);
      device["ms_rounds"] = series.milliseconds;
      device["wall_ms"] = to_json(spread(series.wall_milliseconds));
      device["wall_ms_rounds"] = series.wall_milliseconds;
      device["noise"] = relative_noise(series.milliseconds);
      device["build_ms"] = series.build_milliseconds;
      device["structure_bytes"] = series.structure_bytes;
      device["compile_ms"] = series.compile_milliseconds;
      if (series.first_picture_milliseconds) device["first_picture_ms"] = *series.first_picture_milliseconds;
      device["rays"] = series.rays;
      device["mrays"] = per_second_in_millions(static_cast<double>(series.rays), times.median);
      device["msamples"] = per_second_in_millions(camera_paths(run.job), times.median);
      device["speed_ratio"] = to_json(ratio_interval(run.series.front().milliseconds, series.milliseconds));
      entry["devices"].push_back(std::move(device));
    }
    json["runs"].push_back(std::move(entry));
  }
  json["left_out"] = report.left_out;
  json["warnings"] = noise_warnings(report);
  json["peak_bytes"] = report.peak_bytes;
  json["format"] = bench_format;
  json["version"] = TANDEM_VERSION;
  return json;
}

std::string csv(const BenchReport& report) {
  std::string text =
      "scene,varied,width,height,spp,depth,sampler,trace,threads,device,round,ms,wall_ms,rays,build_ms,compile_ms\n";
  for (const BenchRun& run : report.runs)
    for (const BenchSeries& series : run.series)
      for (std::size_t round = 0; round < series.milliseconds.size(); ++round)
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                       field(run.job.scene), field(run_text(run)), run.job.settings.width, run.job.settings.height,
                       run.job.samples, run.job.settings.max_depth,
                       name_of(pathtracer::sampler_names(), run.job.settings.sampler), pathtracer::name(series.trace),
                       series.threads, field(series.device.name), round + 1, series.milliseconds[round],
                       series.wall_milliseconds[round], series.rays, series.build_milliseconds,
                       series.compile_milliseconds);
  return text;
}

}  // namespace tandem::tools
