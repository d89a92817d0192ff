#include "tools/report/diff_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/report/baseline_report.hpp"
#include "tools/report/classification_report.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/metrics_report.hpp"
#include "tools/report/probe_report.hpp"

namespace tandem::tools {
namespace {

double mrays(const Rendering& rendering) {
  return per_second_in_millions(static_cast<double>(rendering.rays), rendering.milliseconds);
}

/// The count behind a fraction of pixels.
std::uint64_t pixel_count(const DiffReport& report, double fraction) {
  return static_cast<std::uint64_t>(std::llround(fraction * static_cast<double>(report.metrics.pixels)));
}

}  // namespace

std::vector<std::string> failures(const DiffReport& report) {
  std::vector<std::string> sentences = report.verdict.reasons;
  if (report.baseline) {
    const auto add = [&](char side, const compare::Verdict& verdict) {
      for (const std::string& reason : verdict.reasons)
        sentences.push_back(fmt::format("Since '{}', {} has changed: {}", report.baseline->folder, side, reason));
    };
    add('a', report.baseline->a.verdict);
    add('b', report.baseline->b.verdict);
  }
  return sentences;
}

std::string table(const DiffReport& report) {
  const compare::Metrics& metrics = report.metrics;
  std::string text;
  const auto line = [&](const char* name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "{:<18}{}\n", name, value);
  };
  const auto columns = [&](const char* name, const std::string& a, const std::string& b) {
    const std::size_t width =
        std::max({report.a.device.description.size(), report.a.device.driver.size(), std::size_t{20}});
    line(name, fmt::format("{:<{}}{}", a, width + 2, b));
  };
  const auto fraction = [&](const char* name, double value) {
    line(name, fmt::format("{:9.5f} %  {} pixels", 100.0 * value, pixel_count(report, value)));
  };

  line("scene", scene_text(report.job));
  line("settings", settings_text(report.job));
  text += '\n';
  columns("", "a", "b");
  columns("device", report.a.device.name, report.b.device.name);
  columns("hardware", report.a.device.description, report.b.device.description);
  columns("driver", report.a.device.driver, report.b.device.driver);
  columns("trace", std::string(pathtracer::name(report.a.trace)), std::string(pathtracer::name(report.b.trace)));
  columns("time", fmt::format("{:.2f} ms", report.a.milliseconds), fmt::format("{:.2f} ms", report.b.milliseconds));
  columns("rays", fmt::format("{}", report.a.rays), fmt::format("{}", report.b.rays));
  columns("speed", fmt::format("{:.3f} Mrays/s", mrays(report.a)), fmt::format("{:.3f} Mrays/s", mrays(report.b)));
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
  if (report.detailed_metrics) text += table(*report.detailed_metrics);
  text += '\n';
  line("tier", compare::name(report.verdict.tier));
  line("verdict", compare::name(report.verdict));
  for (const std::string& reason : report.verdict.reasons) line("", reason);
  if (report.statistics) text += '\n' + table(*report.statistics);
  if (report.classification) text += '\n' + table(*report.classification);
  if (report.probes) text += '\n' + table(*report.probes);
  if (report.baseline) text += '\n' + table(*report.baseline);
  return text;
}

nlohmann::ordered_json to_json(const DiffReport& report) {
  const compare::Metrics& metrics = report.metrics;
  nlohmann::ordered_json json;
  json["verdict"] = compare::name(report.verdict);
  json["tier"] = compare::name(report.verdict.tier);
  json["reasons"] = report.verdict.reasons;
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
  json["ms_a"] = report.a.milliseconds;
  json["ms_b"] = report.b.milliseconds;
  json["build_ms_a"] = report.a.build_milliseconds;
  json["build_ms_b"] = report.b.build_milliseconds;
  json["rays_a"] = report.a.rays;
  json["rays_b"] = report.b.rays;
  json["mrays_a"] = mrays(report.a);
  json["mrays_b"] = mrays(report.b);
  json["device_a"] = to_json(report.a.device);
  json["device_b"] = to_json(report.b.device);
  json["trace_a"] = pathtracer::name(report.a.trace);
  json["trace_b"] = pathtracer::name(report.b.trace);
  json["settings"] = settings_json(report.job, report.a.camera, report.a.background);
  json["thresholds"] = nlohmann::ordered_json::object();
  for (const compare::Rule& rule : report.thresholds.rules)
    if (compare::applies(rule.metric, report.thresholds.tier))
      json["thresholds"][compare::name(rule.metric)] = {{"limit", rule.limit}, {"reason", rule.reason}};
  if (report.detailed_metrics) json["metrics"] = to_json(*report.detailed_metrics);
  if (report.statistics) json["statistics"] = to_json(*report.statistics);
  if (report.classification) json["classification"] = to_json(*report.classification);
  if (report.probes) json["probes"] = to_json(*report.probes);
  if (report.baseline) json["baseline"] = to_json(*report.baseline);
  json["version"] = TANDEM_VERSION;
  return json;
}

}  // namespace tandem::tools
