#include "tools/suite/suite_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include "base/base64.hpp"
#include "base/input_file.hpp"
#include "compare/report/page_sources.hpp"
#include "tools/output/xml_text.hpp"

namespace tandem::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Beside that of the pages of single comparisons.
constexpr std::string_view suite_style = R"(
body { max-width: none; }
td.cell { min-width: 20rem; max-width: 26rem; padding: .6rem 1rem .6rem 0; }
tbody th { padding-top: .6rem; }
.pictures { display: flex; gap: .4rem; float: left; margin: 0 .8rem .2rem 0; }
.pictures img { width: 112px; height: 112px; object-fit: contain; background: #000; }
.agree, .explained { color: var(--good); } .differ, .failed { color: var(--bad); }
.reasons { clear: both; margin: .2rem 0 0; overflow-wrap: anywhere; }
)";

/// A picture that the page holds, with a link to its file, which a browser shows as large as it is.
std::string image(const std::filesystem::path& folder, const std::string& file, const std::string& words) {
  constexpr std::uint64_t most_bytes = 1u << 30;
  const std::string bytes = read_bytes(folder / file, most_bytes);
  return fmt::format("<a href=\"{0}\"><img alt=\"{1}\" title=\"{1}\" src=\"data:image/png;base64,{2}\"></a>",
                     xml_text(file), xml_text(words), base64(std::as_bytes(std::span(bytes))));
}

std::string string(const Json& json, const char* key) { return json.at(key).get<std::string>(); }

/// Smaller is worse.
std::tuple<int, double> rank(const SuiteResult& result) {
  if (result.failed()) return {0, 0.0};
  return {result.agrees()                               ? 3
          : string(result.json, "state") == "explained" ? 2
                                                        : 1,
          result.json.at("report").at("bit_equal").get<double>()};
}

/// "3 rounding, 1 edge or vertex tie": pixels by the class of their difference, where they were classified.
std::string class_counts(const Json& report) {
  std::vector<std::string> counts;
  if (report.contains("classification"))
    for (const auto& [name, count] : report.at("classification").at("pixel_classes").items())
      if (count.get<std::uint64_t>() > 0) counts.push_back(fmt::format("{} {}", count.get<std::uint64_t>(), name));
  return fmt::format("{}", fmt::join(counts, ", "));
}

/// What the suite sets for the comparison: "size 128x128, spp 16, classify true".
std::string given_text(const SuiteResult& result) {
  std::vector<std::string> settings;
  if (result.json.contains("key"))
    for (const auto& [name, value] : result.json.at("key").at("given").items())
      settings.push_back(fmt::format("{} {}", name, value.is_string() ? value.get<std::string>() : value.dump()));
  return fmt::format("{}", fmt::join(settings, ", "));
}

std::string cell_html(const SuiteResult& result, const std::filesystem::path& folder) {
  const Json& json = result.json;
  const std::string state = string(json, "state");
  std::string html;
  const auto add = [&]<typename... Arguments>(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(html), format, std::forward<Arguments>(arguments)...);
  };
  if (!result.failed()) {
    add("<div class=\"pictures\">{}{}</div>", image(folder, string(json, "picture"), "a: " + string(json, "a")),
        image(folder, string(json, "difference"), "difference"));
  }
  add("<strong class=\"{}\">{}</strong>", state, state);
  if (!result.failed()) {
    const Json& report = json.at("report");
    add(", {:.4f} % bit-equal", 100 * report.at("bit_equal").get<double>());
    const std::string classes = class_counts(report);
    if (!classes.empty()) add("<br>{}", xml_text(classes));
    add("<br><span class=\"hint\">{:.0f} ms, {:.0f} ms; compiling {:.0f} ms, {:.0f} ms</span>",
        report.at("ms_a").get<double>(), report.at("ms_b").get<double>(), report.at("compile_ms_a").get<double>(),
        report.at("compile_ms_b").get<double>());
  }
  const std::string given = given_text(result);
  if (!given.empty()) add("<br><span class=\"hint\">{}</span>", xml_text(given));
  if (json.contains("page")) add(" <a href=\"{}\">details</a>", xml_text(string(json, "page")));
  if (!json.at("reasons").empty()) {
    html += "<ul class=\"reasons\">";
    for (const std::string reason : json.at("reasons")) add("<li>{}</li>", xml_text(reason));
    html += "</ul>";
  }
  return html;
}

/// Each device that took part, once, with what it is, in the order of the comparisons.
std::vector<std::string> device_sentences(const std::vector<SuiteResult>& results) {
  std::vector<std::string> sentences;
  for (const SuiteResult& result : results) {
    if (result.failed()) continue;
    for (const char* side : {"device_a", "device_b"}) {
      const Json& device = result.json.at("report").at(side);
      const std::string sentence =
          fmt::format("{}: {}, {}", string(device, "name"), string(device, "description"), string(device, "driver"));
      if (std::ranges::count(sentences, sentence) == 0) sentences.push_back(sentence);
    }
  }
  return sentences;
}

/// "2026-11-30 09:12 UTC", or the first and the last date on which the results were computed.
std::string dates_text(const std::vector<SuiteResult>& results) {
  std::set<std::string> dates;
  for (const SuiteResult& result : results) dates.insert(result.json.value("date", std::string("unknown date")));
  if (dates.empty()) return {};
  return dates.size() == 1 ? *dates.begin() : fmt::format("{} to {}", *dates.begin(), *dates.rbegin());
}

/// A count in the color of its state, unless there are none.
std::string count_text(const Json& totals, const char* state, std::string_view words) {
  const int count = totals.at(state).get<int>();
  const std::string text = fmt::format("{} {}", count, words);
  return count == 0 ? text : fmt::format("<span class=\"{}\">{}</span>", state, text);
}

}  // namespace

std::string suite_page(const std::string& title, const std::vector<SuiteResult>& results,
                       const std::filesystem::path& folder) {
  using Column = std::tuple<std::string, std::string, std::string>;  // a, b, settings
  std::vector<Column> columns;
  std::map<std::string, std::map<Column, const SuiteResult*>> rows;
  std::vector<std::pair<std::tuple<int, double>, std::string>> order;
  for (const SuiteResult& result : results) {
    const Column column = {string(result.json, "a"), string(result.json, "b"), string(result.json, "settings")};
    if (std::ranges::count(columns, column) == 0) columns.push_back(column);
    rows[string(result.json, "scene")][column] = &result;
  }
  for (const auto& [scene, cells] : rows) {
    std::tuple<int, double> worst = {4, 0.0};
    for (const auto& [column, result] : cells) worst = std::min(worst, rank(*result));
    order.emplace_back(worst, scene);
  }
  std::ranges::sort(order);

  const Json totals = to_json(results);
  std::string html;
  const auto add = [&]<typename... Arguments>(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(html), format, std::forward<Arguments>(arguments)...);
  };
  add("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{0}</title>\n<style>{1}{2}</style>\n</head>\n<body>\n<h1>{0}</h1>\n",
      xml_text(title), compare::page_style(), suite_style);
  add("<p>{} comparisons: {}, {}, {}, {}. The worst scenes come first; times are those of a and of b.</p>\n",
      results.size(), count_text(totals, "agree", "agree"), count_text(totals, "explained", "are explained"),
      count_text(totals, "differ", "differ"), count_text(totals, "failed", "failed"));
  for (const std::string& sentence : device_sentences(results)) add("<p class=\"hint\">{}</p>\n", xml_text(sentence));
  add("<p class=\"hint\">Compared {}, tandem {}</p>\n<div class=\"scroll\"><table>\n<thead><tr><th>scene</th>",
      dates_text(results), TANDEM_VERSION);
  for (const auto& [a, b, settings] : columns)
    add("<th>{} against {}<br><span class=\"hint\">{}</span></th>", xml_text(a), xml_text(b), xml_text(settings));
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& [worst, scene] : order) {
    add("<tr><th>{}</th>", xml_text(scene));
    const std::map<Column, const SuiteResult*>& cells = rows.at(scene);
    for (const Column& column : columns) {
      const auto found = cells.find(column);
      add("<td class=\"cell\">{}</td>", found == cells.end() ? std::string() : cell_html(*found->second, folder));
    }
    html += "</tr>\n";
  }
  return html + "</tbody>\n</table></div>\n</body>\n</html>\n";
}

}  // namespace tandem::tools
