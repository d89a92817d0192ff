#include "tools/bench/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include "base/base64.hpp"
#include "compare/report/page_sources.hpp"
#include "tools/output/xml_text.hpp"
#include "tools/plot/plot.hpp"
#include "tools/report/interval.hpp"
#include "tools/report/job_report.hpp"
#include "tools/report/speed.hpp"

namespace tandem::tools {
namespace {

constexpr std::string_view bench_style = R"(
body { max-width: 72rem; }
.plots { display: flex; flex-wrap: wrap; gap: 1.5rem; }
td, th { text-align: right; padding: .15rem .6rem; } td:first-child, th:first-child { text-align: left; }
.warning { color: var(--bad); }
)";

std::string file_name(const std::string& scene) { return scene.substr(scene.rfind('/') + 1); }

/// The number that stands for a value on an axis: pixels for a size.
std::optional<double> number_of(std::string_view value) {
  const auto parsed = [](std::string_view text) -> std::optional<double> {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
  };
  if (const std::size_t by = value.find('x'); by != std::string_view::npos) {
    const auto width = parsed(value.substr(0, by)), height = parsed(value.substr(by + 1));
    return width && height ? std::optional(*width * *height) : std::nullopt;
  }
  return parsed(value);
}

PlotPoint point_of(double x, const BenchSeries& series) {
  const MedianInterval interval = median_interval(series.milliseconds);
  return {.x = x, .y = interval.median, .least = interval.least, .most = interval.most};
}

/// Frame time against one option, a series for each device and each combination of the others.
Plot plot_of(const std::vector<const BenchRun*>& runs, std::size_t option) {
  const std::string& name = runs.front()->varied[option].first;
  std::vector<std::string> values;
  for (const BenchRun* run : runs)
    if (const std::string& value = run->varied[option].second; std::ranges::find(values, value) == values.end())
      values.push_back(value);
  const bool is_numeric =
      std::ranges::all_of(values, [](const std::string& each) { return number_of(each).has_value(); });
  const bool has_size = is_numeric && values.front().find('x') != std::string::npos;
  Plot plot{.title = fmt::format("{}: frame time against {}", file_name(runs.front()->job.scene), name),
            .x = {.label = has_size ? "pixels" : name, .includes_zero = true, .names = {}},
            .y = {.label = "milliseconds", .includes_zero = true},
            .series = {}};
  if (!is_numeric) plot.x.names = values;
  std::map<std::string, std::size_t> places;
  for (const BenchRun* run : runs) {
    const std::string& value = run->varied[option].second;
    const double x =
        is_numeric ? *number_of(value) : static_cast<double>(std::ranges::find(values, value) - values.begin());
    std::string others;
    for (std::size_t i = 0; i < run->varied.size(); ++i)
      if (i != option) others += fmt::format(", {} {}", run->varied[i].first, run->varied[i].second);
    for (const BenchSeries& series : run->series) {
      const std::string label = series.device.name + others;
      const auto [place, is_new] = places.try_emplace(label, plot.series.size());
      if (is_new) plot.series.push_back({.label = label, .points = {}, .has_line = is_numeric});
      plot.series[place->second].points.push_back(point_of(x, series));
    }
  }
  for (PlotSeries& series : plot.series) std::ranges::stable_sort(series.points, {}, &PlotPoint::x);
  return plot;
}

/// Of runs without a varied option: scenes side by side.
Plot plot_of_scenes(const BenchReport& report) {
  Plot plot{.title = "Frame time by scene",
            .x = {.label = "", .names = {}},
            .y = {.label = "milliseconds", .is_logarithmic = true},
            .series = {}};
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < report.runs.size(); ++i) {
    plot.x.names.push_back(file_name(report.runs[i].job.scene));
    for (const BenchSeries& series : report.runs[i].series) {
      const auto [place, is_new] = places.try_emplace(series.device.name, plot.series.size());
      if (is_new) plot.series.push_back({.label = series.device.name, .points = {}, .has_line = false});
      plot.series[place->second].points.push_back(point_of(static_cast<double>(i), series));
    }
  }
  return plot;
}

std::string plots(const BenchReport& report) {
  std::string html;
  for (std::size_t first = 0; first < report.runs.size();) {
    std::vector<const BenchRun*> runs;
    const std::string& scene = report.runs[first].job.scene;
    for (; first < report.runs.size() && report.runs[first].job.scene == scene; ++first)
      runs.push_back(&report.runs[first]);
    for (std::size_t option = 0; option < runs.front()->varied.size(); ++option)
      if (std::ranges::any_of(runs, [&](const BenchRun* run) {
            return run->varied[option].second != runs.front()->varied[option].second;
          }))
        html += svg(plot_of(runs, option));
  }
  return html.empty() ? svg(plot_of_scenes(report)) : html;
}

std::string table_of(const BenchRun& run) {
  std::string html = fmt::format("<h3>{}, {}</h3>\n", xml_text(scene_text(run.job)), xml_text(settings_text(run.job)));
  if (run.series.empty()) return html + "<p>No device was measured.</p>\n";
  html +=
      "<table><thead><tr><th>device</th><th>trace</th><th>ms</th><th>interval</th><th>wall ms</th><th>Mrays/s</th>"
      "<th>Msamples/s</th><th>times the first device's speed</th><th>build ms</th><th>structures MiB</th>"
      "<th>compile s</th><th>first picture s</th></tr></thead><tbody>\n";
  for (const BenchSeries& series : run.series) {
    const MedianInterval time = median_interval(series.milliseconds);
    const MedianInterval ratio = ratio_interval(run.series.front().milliseconds, series.milliseconds);
    const double samples = static_cast<double>(run.job.settings.width) * run.job.settings.height * run.job.samples;
    fmt::format_to(std::back_inserter(html),
                   "<tr><td title=\"{}, {}\">{}</td><td>{}</td><td>{:.2f}</td><td>{:.2f} to {:.2f}, {:.0f} %</td>"
                   "<td>{:.2f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f} ({:.3f} to {:.3f})</td><td>{:.2f}</td>"
                   "<td>{:.2f}</td><td>{:.2f}</td><td>{}</td></tr>\n",
                   xml_text(series.device.description), xml_text(series.device.driver), xml_text(series.device.name),
                   pathtracer::name(series.trace), time.median, time.least, time.most, 100 * time.confidence,
                   median_interval(series.wall_milliseconds).median,
                   per_second_in_millions(static_cast<double>(series.rays), time.median),
                   per_second_in_millions(samples, time.median), ratio.median, ratio.least, ratio.most,
                   series.build_milliseconds, static_cast<double>(series.structure_bytes) / (1 << 20),
                   series.compile_milliseconds / 1000,
                   series.first_picture_milliseconds ? fmt::format("{:.2f}", *series.first_picture_milliseconds / 1000)
                                                     : std::string("-"));
  }
  return html + "</tbody></table>\n";
}

}  // namespace

std::string bench_page(const BenchReport& report, const std::string& command, const std::string& numbers) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Tandem: performance</title>\n"
      "<style>{}{}</style></head>\n<body><h1>Performance</h1>\n<p><code>{}</code></p>\n"
      "<p>Medians of {} rounds, in which devices and settings take turns; bars and intervals hold the median with the "
      "stated probability.</p>\n",
      compare::page_style(), bench_style, xml_text(command), report.rounds);
  for (const std::string& sentence : report.left_out)
    html += fmt::format("<p class=\"warning\">Left out: {}.</p>\n", xml_text(sentence));
  if (const std::vector<std::string> noisy = noise_warnings(report); !noisy.empty()) {
    html += fmt::format("<details class=\"warning\"><summary>{} noisy series</summary>\n", noisy.size());
    for (const std::string& sentence : noisy) html += fmt::format("<p>{}.</p>\n", xml_text(sentence));
    html += "</details>\n";
  }
  html += fmt::format("<div class=\"plots\">\n{}</div>\n", plots(report));
  for (const BenchRun& run : report.runs) html += table_of(run);
  html += fmt::format(
      "<p><a download=\"bench.json\" href=\"data:application/json;base64,{}\">All numbers as JSON</a></p>\n",
      base64(std::as_bytes(std::span(numbers))));
  return html + "</body></html>\n";
}

}  // namespace tandem::tools
