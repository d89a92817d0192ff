#include "tools/report/bench_report.hpp"

#include <fmt/format.h>

#include <iterator>

#include "tools/report/device_json.hpp"
#include "tools/report/job_report.hpp"
#include "tools/report/speed.hpp"
#include "tools/report/spread.hpp"

namespace tandem::tools {
namespace {

double camera_paths(const compare::JobSummary& job) {
  return static_cast<double>(job.settings.width) * job.settings.height * job.samples;
}

}  // namespace

std::string table(const BenchReport& report) {
  std::string text = fmt::format("{}, {}: {} rounds after one to warm up\n\n", scene_text(report.job),
                                 settings_text(report.job), report.series.front().milliseconds.size());
  const auto row = [&](const auto&... cells) {
    fmt::format_to(std::back_inserter(text), "{:<12}{:<30}{:>12}{:>14}  {}\n", cells...);
  };
  row("device", "ms (min, max)", "Mrays/s", "Msamples/s", "times the first device's speed (min, max)");
  for (const BenchSeries& series : report.series) {
    const Spread times = spread(series.milliseconds);
    const Spread ratio = speed_ratio(report.series.front().milliseconds, series.milliseconds);
    row(series.device.name, fmt::format("{:.1f} ({:.1f}, {:.1f})", times.median, times.least, times.most),
        fmt::format("{:.3f}", per_second_in_millions(static_cast<double>(series.rays), times.median)),
        fmt::format("{:.3f}", per_second_in_millions(camera_paths(report.job), times.median)),
        fmt::format("{:.3f} ({:.3f}, {:.3f})", ratio.median, ratio.least, ratio.most));
  }
  text += '\n';
  for (const BenchSeries& series : report.series) {
    fmt::format_to(std::back_inserter(text), "{:<12}{}, {}, trace {}, shaders compiled in {:.1f} s\n",
                   series.device.name, series.device.description, series.device.driver, pathtracer::name(series.trace),
                   series.compile_milliseconds / 1000);
  }
  return text;
}

nlohmann::ordered_json to_json(const BenchReport& report) {
  nlohmann::ordered_json json;
  json["settings"] = to_json(report.job);
  json["settings"]["threads"] = report.threads;
  json["devices"] = nlohmann::ordered_json::array();
  for (const BenchSeries& series : report.series) {
    const Spread times = spread(series.milliseconds);
    nlohmann::ordered_json entry = to_json(series.device);
    entry["trace"] = pathtracer::name(series.trace);
    entry["ms"] = to_json(times);
    entry["ms_rounds"] = series.milliseconds;
    entry["build_ms"] = series.build_milliseconds;
    entry["compile_ms"] = series.compile_milliseconds;
    entry["rays"] = series.rays;
    entry["mrays"] = per_second_in_millions(static_cast<double>(series.rays), times.median);
    entry["msamples"] = per_second_in_millions(camera_paths(report.job), times.median);
    entry["speed_ratio"] = to_json(speed_ratio(report.series.front().milliseconds, series.milliseconds));
    json["devices"].push_back(std::move(entry));
  }
  json["format"] = json_format;
  json["version"] = TANDEM_VERSION;
  return json;
}

}  // namespace tandem::tools
