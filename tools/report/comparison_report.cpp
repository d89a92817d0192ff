#include "tools/report/comparison_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include <nlohmann/json.hpp>

#include "tools/report/classification_report.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/job_report.hpp"
#include "tools/report/metrics_report.hpp"
#include "tools/report/probe_report.hpp"
#include "tools/report/speed.hpp"
#include "tools/report/statistics_report.hpp"

namespace tandem::tools {
namespace {

double mrays(const compare::Rendering& rendering) {
  return per_second_in_millions(static_cast<double>(rendering.rays), rendering.milliseconds);
}

/// The count behind a fraction of pixels.
std::uint64_t pixel_count(const compare::Comparison& comparison, double fraction) {
  return static_cast<std::uint64_t>(std::llround(fraction * static_cast<double>(comparison.metrics.pixels)));
}

}  // namespace

std::string table(const compare::Comparison& comparison) {
  const compare::Metrics& metrics = comparison.metrics;
  std::string text;
  const auto line = [&](const char* name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "{:<18}{}\n", name, value);
  };
  const auto columns = [&](const char* name, const std::string& a, const std::string& b) {
    const std::size_t width =
        std::max({comparison.a.device.description.size(), comparison.a.device.driver.size(), std::size_t{20}});
    line(name, fmt::format("{:<{}}{}", a, width + 2, b));
  };
  const auto fraction = [&](const char* name, double value) {
    line(name, fmt::format("{:9.5f} %  {} pixels", 100.0 * value, pixel_count(comparison, value)));
  };

  line("scene", scene_text(comparison.job));
  line("settings", settings_text(comparison.job));
  text += '\n';
  columns("", "a", "b");
  columns("device", comparison.a.device.name, comparison.b.device.name);
  columns("hardware", comparison.a.device.description, comparison.b.device.description);
  columns("driver", comparison.a.device.driver, comparison.b.device.driver);
  columns("trace", std::string(pathtracer::name(comparison.a.trace)),
          std::string(pathtracer::name(comparison.b.trace)));
  columns("compiling", fmt::format("{:.2f} ms", comparison.a.compile_milliseconds),
          fmt::format("{:.2f} ms", comparison.b.compile_milliseconds));
  columns("time", fmt::format("{:.2f} ms", comparison.a.milliseconds),
          fmt::format("{:.2f} ms", comparison.b.milliseconds));
  columns("rays", fmt::format("{}", comparison.a.rays), fmt::format("{}", comparison.b.rays));
  columns("speed", fmt::format("{:.3f} Mrays/s", mrays(comparison.a)),
          fmt::format("{:.3f} Mrays/s", mrays(comparison.b)));
  columns("mean", fmt::format("{:.9g}", metrics.mean_a), fmt::format("{:.9g}", metrics.mean_b));
  columns("non-finite pixels", fmt::format("{}", metrics.non_finite_a), fmt::format("{}", metrics.non_finite_b));
  text += '\n';
  line("pixels", fmt::format("{}", metrics.pixels));
  fraction("bit-equal", metrics.bit_equal);
  fraction("within 1e-5", metrics.within_1e5);
  fraction("within 1e-3", metrics.within_1e3);
  line("max difference", fmt::format("{:.6g}", metrics.max_abs));
  line("mean difference", fmt::format("{:.6g}", metrics.mean_abs));
  line("RMSE", fmt::format("{:.6g}", metrics.rmse));
  line("PSNR", metrics.psnr ? fmt::format("{:.2f} dB (peak {:.6g})", *metrics.psnr, metrics.peak)
                            : std::string("infinite (no difference)"));
  if (comparison.detailed_metrics) text += table(*comparison.detailed_metrics);
  text += '\n';
  line("tier", compare::name(comparison.verdict.tier));
  line("verdict", compare::name(comparison.verdict));
  for (const std::string& reason : comparison.verdict.reasons) line("", reason);
  if (comparison.statistics) text += '\n' + table(*comparison.statistics);
  if (comparison.classification) text += '\n' + table(*comparison.classification);
  if (comparison.probes) text += '\n' + table(*comparison.probes);
  return text;
}

nlohmann::ordered_json to_json(const compare::Comparison& comparison) {
  const compare::Metrics& metrics = comparison.metrics;
  nlohmann::ordered_json json;
  json["format"] = json_format;
  json["verdict"] = compare::name(comparison.verdict);
  json["tier"] = compare::name(comparison.verdict.tier);
  json["reasons"] = comparison.verdict.reasons;
  json["pixels"] = metrics.pixels;
  json["bit_equal"] = metrics.bit_equal;
  json["within_1e5"] = metrics.within_1e5;
  json["within_1e3"] = metrics.within_1e3;
  json["max_abs"] = metrics.max_abs;
  json["mean_abs"] = metrics.mean_abs;
  json["mean_a"] = metrics.mean_a;
  json["mean_b"] = metrics.mean_b;
  json["rmse"] = metrics.rmse;
  json["psnr"] = metrics.psnr ? nlohmann::ordered_json(*metrics.psnr) : nlohmann::ordered_json(nullptr);
  json["peak"] = metrics.peak;
  json["non_finite_a"] = metrics.non_finite_a;
  json["non_finite_b"] = metrics.non_finite_b;
  json["ms_a"] = comparison.a.milliseconds;
  json["ms_b"] = comparison.b.milliseconds;
  json["build_ms_a"] = comparison.a.build_milliseconds;
  json["build_ms_b"] = comparison.b.build_milliseconds;
  json["compile_ms_a"] = comparison.a.compile_milliseconds;
  json["compile_ms_b"] = comparison.b.compile_milliseconds;
  json["rays_a"] = comparison.a.rays;
  json["rays_b"] = comparison.b.rays;
  json["mrays_a"] = mrays(comparison.a);
  json["mrays_b"] = mrays(comparison.b);
  json["device_a"] = to_json(comparison.a.device);
  json["device_b"] = to_json(comparison.b.device);
  json["trace_a"] = pathtracer::name(comparison.a.trace);
  json["trace_b"] = pathtracer::name(comparison.b.trace);
  json["settings"] = settings_json(comparison.job, comparison.a.camera, comparison.a.background);
  json["thresholds"] = nlohmann::ordered_json::object();
  for (const compare::Rule& rule : comparison.thresholds.rules)
    if (compare::applies(rule.metric, comparison.thresholds.tier))
      json["thresholds"][compare::name(rule.metric)] = {{"limit", rule.limit}, {"reason", rule.reason}};
  if (comparison.detailed_metrics) json["metrics"] = to_json(*comparison.detailed_metrics);
  if (comparison.statistics) json["statistics"] = to_json(*comparison.statistics);
  if (comparison.classification) json["classification"] = to_json(*comparison.classification);
  if (comparison.probes) json["probes"] = to_json(*comparison.probes);
  json["version"] = TANDEM_VERSION;
  return json;
}

}  // namespace tandem::tools
