#include "tools/report/markov_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "compare/report/page_sources.hpp"
#include "tools/output/xml_text.hpp"
#include "tools/plot/plot.hpp"
#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

using study::FredholmResult;
using study::WalkEstimatorResult;
using study::WalkMeasurement;

const std::string& name_of(const WalkEstimatorResult& result) {
  static const std::vector<std::string> names = study::walk_estimator_names();
  return names[static_cast<std::size_t>(result.estimator)];
}

void add_table(std::string& text, const FredholmResult& result) {
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "### {}: {}\n\n| {:<15} |", result.equation.name, result.equation.formula, "estimator");
  const std::vector<WalkMeasurement>& counts = result.estimators.front().measurements;
  for (const WalkMeasurement& measurement : counts)
    fmt::format_to(out, " {:>11} |", fmt::format("RMSE {}", measurement.walks));
  fmt::format_to(out, " {:>6} | {:>8} | {:>10} | {:>9} | {:>7} | {:>10} |\n|-----------------|", "slope", "variance",
                 "(V/N)^1/2", "largest z", "seconds", "efficiency");
  for (std::size_t i = 0; i < counts.size(); ++i) text += "------------:|";
  text += "-------:|---------:|-----------:|----------:|--------:|-----------:|\n";
  for (const WalkEstimatorResult& estimator : result.estimators) {
    const WalkMeasurement& last = estimator.measurements.back();
    fmt::format_to(out, "| {:<15} |", name_of(estimator));
    for (const WalkMeasurement& measurement : estimator.measurements)
      fmt::format_to(out, " {:>11.7f} |", measurement.rmse);
    fmt::format_to(out, " {:>6.3f} | {:>8.4f} | {:>10.7f} | {:>9.2f} | {:>7.3f} | {:>10.2f} |\n", estimator.slope(),
                   estimator.variance, last.expected, last.largest_z, last.seconds,
                   estimator.efficiency() / result.estimators.front().efficiency());
  }
  fmt::format_to(out, "| {:<15} |", "N^-1/2");
  for (const WalkMeasurement& measurement : counts)
    fmt::format_to(out, " {:>11.7f} |", 1 / std::sqrt(static_cast<double>(measurement.walks)));
  fmt::format_to(out, " {:>6.3f} | {:>8} | {:>10} | {:>9} | {:>7} | {:>10} |\n\n", -0.5, "", "", "", "", "");
}

nlohmann::ordered_json to_json(const WalkEstimatorResult& result) {
  nlohmann::ordered_json json;
  json["name"] = name_of(result);
  json["slope"] = result.slope();
  json["variance"] = result.variance;
  json["efficiency"] = result.efficiency();
  json["measurements"] = nlohmann::ordered_json::array();
  for (const WalkMeasurement& measurement : result.measurements)
    json["measurements"].push_back({{"walks", measurement.walks},
                                    {"rmse", measurement.rmse},
                                    {"expected_rmse", measurement.expected},
                                    {"largest_z", measurement.largest_z},
                                    {"seconds", measurement.seconds}});
  return json;
}

}  // namespace

std::string plots_page(const MarkovReport& report) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Tandem: random walks</title>\n"
      "<style>{}</style></head>\n<body><h1>Integral equations by random walks</h1>\n<p>On {}, {}.</p>\n",
      compare::page_style(), xml_text(report.device.name), xml_text(report.device.description));
  for (const FredholmResult& result : report.equations) {
    Plot plot{.title = fmt::format("{}: {}", result.equation.name, result.equation.formula),
              .x = {.label = "walks from each point", .is_logarithmic = true, .names = {}},
              .y = {.label = "RMSE", .is_logarithmic = true},
              .series = {}};
    for (const WalkEstimatorResult& estimator : result.estimators) {
      PlotSeries series{.label = fmt::format("{}, slope {:.2f}", name_of(estimator), estimator.slope()), .points = {}};
      for (const WalkMeasurement& each : estimator.measurements)
        series.points.push_back({.x = static_cast<double>(each.walks), .y = each.rmse});
      plot.series.push_back(std::move(series));
    }
    PlotSeries root{.label = "N^-1/2", .points = {}, .has_marks = false, .is_dashed = true};
    for (const WalkMeasurement& each : result.estimators.front().measurements)
      root.points.push_back(
          {.x = static_cast<double>(each.walks), .y = 1 / std::sqrt(static_cast<double>(each.walks))});
    plot.series.push_back(std::move(root));
    html += svg(plot);
  }
  return html + "</body></html>\n";
}

std::string markdown(const MarkovReport& report) {
  const study::WalkSettings& walks = report.settings.walks;
  std::string text = fmt::format(
      "Measured on {} ({}) by `tandem study markov`: solutions e^x at {} points of [0, 1], N walks from each. Fixed "
      "lengths are {} steps, walks are absorbed with the probability {:g} at each state, the seed is {}.\n\n",
      report.device.name, report.device.description, walks.points, walks.length, walks.absorption, walks.seed);
  for (const FredholmResult& result : report.equations) add_table(text, result);
  return text;
}

nlohmann::ordered_json to_json(const MarkovReport& report) {
  const study::WalkSettings& walks = report.settings.walks;
  nlohmann::ordered_json json;
  json["format"] = json_format;
  json["device"] = to_json(report.device);
  json["points"] = walks.points;
  json["absorption"] = walks.absorption;
  json["length"] = walks.length;
  json["seed"] = walks.seed;
  json["equations"] = nlohmann::ordered_json::array();
  for (const FredholmResult& result : report.equations) {
    nlohmann::ordered_json estimators = nlohmann::ordered_json::array();
    for (const WalkEstimatorResult& estimator : result.estimators) estimators.push_back(to_json(estimator));
    json["equations"].push_back({{"name", result.equation.name},
                                 {"equation", result.equation.formula},
                                 {"norm", result.equation.norm},
                                 {"estimators", std::move(estimators)}});
  }
  return json;
}

}  // namespace tandem::tools
