#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "compare/report/page_sources.hpp"
#include "tools/output/xml_text.hpp"
#include "tools/report/job_report.hpp"
#include "tools/suite/gallery.hpp"

// The pages of a gallery: for code hosts, and for a browser.

namespace tandem::tools {
namespace {

/// Beside that of the pages of single comparisons.
constexpr std::string_view gallery_style = R"(
td img { width: 192px; display: block; background: #000; }
td { min-width: 7rem; padding: .6rem 1rem .6rem 0; }
.agree, .explained { color: var(--good); } .differ { color: var(--bad); }
.reasons { overflow-wrap: anywhere; }
)";

/// The words of a row that both pages show.
struct Row {
  const GalleryScene& scene;
  std::string settings;
  std::string bit_equal;
  std::string means;
  std::string seconds;
  std::string compiling;
};

const compare::Rule& bit_equal_rule(const compare::Comparison& comparison) {
  return comparison.thresholds.rule(compare::RuleMetric::bit_equal);
}

double relative_mean_difference(const compare::Metrics& metrics) {
  const double largest = std::max(std::abs(metrics.mean_a), std::abs(metrics.mean_b));
  return largest > 0 ? std::abs(metrics.mean_a - metrics.mean_b) / largest : 0.0;
}

Row row_of(const GalleryResult& result) {
  const compare::Comparison& comparison = result.comparison;
  const auto seconds = [](double a, double b) { return fmt::format("{:.2f}, {:.2f}", a / 1000, b / 1000); };
  return {.scene = result.scene,
          .settings = settings_text(comparison.job),
          .bit_equal = fmt::format("{:.3f} %, at least {:g} %", 100 * comparison.metrics.bit_equal,
                                   100 * bit_equal_rule(comparison).limit),
          .means = fmt::format("{:.1e}", relative_mean_difference(comparison.metrics)),
          .seconds = seconds(comparison.a.milliseconds, comparison.b.milliseconds),
          .compiling = seconds(comparison.a.compile_milliseconds, comparison.b.compile_milliseconds)};
}

/// Results whose rule for equal pixels is not the gallery's own.
std::vector<const GalleryResult*> with_own_rule(const Gallery& gallery) {
  const compare::Thresholds usual = gallery_thresholds();
  std::vector<const GalleryResult*> results;
  for (const GalleryResult& result : gallery.results)
    if (bit_equal_rule(result.comparison).reason != usual.rule(compare::RuleMetric::bit_equal).reason)
      results.push_back(&result);
  return results;
}

std::string unfinished_text(const Gallery& gallery) {
  return fmt::format("The run ended early: {} of {} scenes were rendered.", gallery.results.size(), gallery.listed);
}

/// Words in a line or a table's cell of Markdown, which mean nothing but themselves.
std::string markdown_text(std::string_view words) {
  constexpr std::string_view special = R"(\`*_{}[]<>()#|~!&)";
  std::string text;
  for (const char c : words) {
    if (special.find(c) != std::string_view::npos) text += '\\';
    text += c == '\n' || c == '\r' || c == '\t' ? ' ' : c;
  }
  return text;
}

/// A file's name as code; names with backquotes have more of them around.
std::string markdown_code(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '|', ' ');
  std::size_t longest = 0, run = 0;
  for (const char c : text) longest = std::max(longest, run = c == '`' ? run + 1 : 0);
  const std::string fence(longest + 1, '`');
  return longest == 0 ? fence + text + fence : fmt::format("{0} {1} {0}", fence, text);
}

/// The path as a relative URL (RFC 3986): all but unreserved characters and slashes are percent-encoded.
std::string url(const std::filesystem::path& path) {
  std::string text;
  for (const char c : path.generic_string()) {
    const bool is_alphanumeric = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (is_alphanumeric || std::string_view("-._~/").find(c) != std::string_view::npos)
      text += c;
    else
      text += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return text;
}

template <typename... Arguments>
void add_line(std::string& text, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Arguments>(arguments)...);
  text += "\n";
}

}  // namespace

std::string gallery_markdown(const Gallery& gallery) {
  std::string text = "# Gallery\n\n";
  add_line(text,
           "Written by `tandem gallery` on {} (version {}). Each scene is rendered on two devices, from the same "
           "shader,\nseed and scene:\n",
           gallery.date, TANDEM_VERSION);
  if (!gallery.results.empty()) {
    const compare::Comparison& first = gallery.results.front().comparison;
    add_line(text, "| | device | hardware | driver |\n|---|---|---|---|");
    for (const auto& [side, device] : {std::pair("a", &first.a.device), std::pair("b", &first.b.device)})
      add_line(text, "| {} | {} | {} | {} |", side, markdown_text(device->name), markdown_text(device->description),
               markdown_text(device->driver));
  }
  add_line(text, "\nThe picture is that of a; beside it, bright where b differs from it, the relative difference.\n");
  if (gallery.results.size() < gallery.listed) add_line(text, "{}\n", unfinished_text(gallery));
  add_line(text,
           "| scene | a | difference | settings | bit-equal pixels | means differ by | seconds a, b | "
           "compiling a, b | verdict |");
  add_line(text, "|---|---|---|---|---|---|---|---|---|");
  for (const GalleryResult& result : gallery.results) {
    const Row row = row_of(result);
    const compare::Verdict& verdict = result.comparison.verdict;
    const std::string title = markdown_text(row.scene.title);
    std::string judgement = compare::name(verdict);
    if (!verdict.reasons.empty())
      judgement =
          fmt::format("**{}**: {}", judgement, markdown_text(fmt::format("{}", fmt::join(verdict.reasons, "; "))));
    add_line(text, "| {}<br>{} | ![{}]({}) | ![]({}) | {} | {} | {} | {} | {} | {} |", title,
             markdown_code(row.scene.file.filename().string()), title, url(picture_path(row.scene)),
             url(difference_path(row.scene)), row.settings, row.bit_equal, row.means, row.seconds, row.compiling,
             judgement);
  }
  const std::vector<const GalleryResult*> own = with_own_rule(gallery);
  if (!own.empty()) add_line(text, "\nWhy some scenes may differ at more pixels:\n");
  for (const GalleryResult* result : own)
    add_line(text, "- {}: {}", markdown_code(result->scene.name),
             markdown_text(bit_equal_rule(result->comparison).reason));
  return text;
}

std::string gallery_html(const Gallery& gallery) {
  std::string text;
  add_line(text,
           "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
           "content=\"width=device-width\">\n<title>Gallery</title>\n<style>{}{}</style>\n</head>\n<body>\n"
           "<h1>Gallery</h1>",
           compare::page_style(), gallery_style);
  std::size_t count[3] = {};
  for (const GalleryResult& result : gallery.results)
    ++count[static_cast<std::size_t>(result.comparison.verdict.outcome)];
  const auto of = [&](compare::Outcome outcome) { return count[static_cast<std::size_t>(outcome)]; };
  add_line(text,
           "<p>{} scenes, each rendered on two devices from the same shader and seed: {} agree, {} are explained, "
           "{} differ.</p>",
           gallery.results.size(), of(compare::Outcome::agree), of(compare::Outcome::explained),
           of(compare::Outcome::differ));
  if (gallery.results.size() < gallery.listed) add_line(text, "<p class=\"problem\">{}</p>", unfinished_text(gallery));
  add_line(text, "<p class=\"hint\">{}, tandem {}: <code>{}</code></p>", gallery.date, TANDEM_VERSION,
           xml_text(gallery.command));
  if (!gallery.results.empty()) {
    const compare::Comparison& first = gallery.results.front().comparison;
    for (const auto& [side, device] : {std::pair("a", &first.a.device), std::pair("b", &first.b.device)})
      add_line(text, "<p class=\"hint\">{}: {}, {}, {}</p>", side, xml_text(device->name),
               xml_text(device->description), xml_text(device->driver));
  }
  add_line(text,
           "<div class=\"scroll\"><table>\n<thead><tr><th>scene</th><th>a</th><th>relative difference</th>"
           "<th>settings</th><th>bit-equal pixels</th><th>means differ by</th><th>seconds a, b</th>"
           "<th>compiling a, b</th><th>verdict</th></tr></thead>\n<tbody>");
  for (const GalleryResult& result : gallery.results) {
    const Row row = row_of(result);
    const compare::Verdict& verdict = result.comparison.verdict;
    const std::string title = xml_text(row.scene.title);
    const auto picture = [](const std::filesystem::path& path, const std::string& words) {
      return fmt::format("<a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\"></a>", url(path), words);
    };
    add_line(text, "<tr><th>{}<br><code>{}</code></th><td>{}</td><td>{}</td>", title,
             xml_text(row.scene.file.filename().string()), picture(picture_path(row.scene), title),
             picture(difference_path(row.scene), title + ": difference"));
    for (const std::string* words : {&row.settings, &row.bit_equal, &row.means, &row.seconds, &row.compiling})
      text += fmt::format("<td>{}</td>", xml_text(*words));
    add_line(text, "<td class=\"reasons\"><strong class=\"{0}\">{0}</strong>{1}{2}</td></tr>", compare::name(verdict),
             verdict.reasons.empty() ? "" : "<br>", xml_text(fmt::format("{}", fmt::join(verdict.reasons, "; "))));
  }
  add_line(text, "</tbody>\n</table></div>");
  const std::vector<const GalleryResult*> own = with_own_rule(gallery);
  if (!own.empty()) add_line(text, "<p>Why some scenes may differ at more pixels:</p>\n<ul>");
  for (const GalleryResult* result : own)
    add_line(text, "<li><code>{}</code>: {}</li>", xml_text(result->scene.name),
             xml_text(bit_equal_rule(result->comparison).reason));
  if (!own.empty()) add_line(text, "</ul>");
  add_line(text, "</body>\n</html>");
  return text;
}

}  // namespace tandem::tools
