#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include "tools/report/explanation_report.hpp"
#include "tools/report/job_report.hpp"
#include "tools/report/probe_report.hpp"

// The text that `tandem explain` prints.

namespace tandem::tools {
namespace {

using compare::EventField;
using compare::EventPair;
using pathtracer::EventKind;

constexpr std::uint32_t no_distance = std::numeric_limits<std::uint32_t>::max();

/// A line of the events.
struct Row {
  enum class Weight { heading, plain, observed, differing };
  Weight weight = Weight::plain;
  std::string name;
  std::string a = {}, b = {};  ///< b empty: the same as a
  std::string note = {};
};

constexpr std::string_view bold = "\033[1m", yellow = "\033[33m", dim = "\033[2m", usual = "\033[0m";

std::string_view color_of(Row::Weight weight) {
  switch (weight) {
    case Row::Weight::heading:
      return bold;
    case Row::Weight::observed:
      return dim;
    case Row::Weight::differing:
      return yellow;
    default:
      return {};
  }
}

/// Units in the last place of what is that close, else relative; nothing for what is no number.
std::string distance_text(std::uint32_t ulp, double relative) {
  constexpr std::uint32_t close = 1u << 20u;
  if (ulp < close) return fmt::format("{} ULP", ulp);
  return std::isfinite(relative) ? fmt::format("{:.2g} relative", relative) : std::string();
}

/// What an event that is the same on both devices is told by, in one line.
std::string_view telling_field(EventKind kind) {
  switch (kind) {
    case EventKind::camera:
      return "direction";
    case EventKind::segment:
      return "throughput";
    case EventKind::ray:
      return "answer";
    case EventKind::surface:
      return "material";
    case EventKind::medium:
      return "scattered";
    case EventKind::emission:
    case EventKind::direct_light:
      return "contribution";
    case EventKind::light_sample:
      return "light";
    case EventKind::light_value:
      return "weight";
    case EventKind::visibility:
      return "visibility";
    case EventKind::scatter:
      return "lobe";
    case EventKind::roulette:
      return "survives";
    case EventKind::end:
      return "reason";
  }
  return {};
}

Row field_row(const EventPair& pair, const EventField& field, const compare::SceneNames& names) {
  Row row{.name = fmt::format("    {}", field.name)};
  if (pair.a) row.a = names.text(field, *pair.a);
  if (!pair.a || !pair.b) {
    row.weight = Row::Weight::differing;
    row.b = pair.b ? names.text(field, *pair.b) : "-";
    if (!pair.a) row.a = "-";
  } else if (compare::differs(pair, field)) {
    row.weight = field.tier == compare::FieldTier::observed ? Row::Weight::observed : Row::Weight::differing;
    row.b = names.text(field, *pair.b);
    row.note = distance_text(compare::ulp_distance(field, *pair.a, *pair.b),
                             compare::relative_difference(field, *pair.a, *pair.b));
  }
  return row;
}

/// The event with all its fields.
void add_whole(const EventPair& pair, const compare::SceneNames& names, std::vector<Row>& rows) {
  const char* const only = !pair.b ? ", on a only" : !pair.a ? ", on b only" : "";
  rows.push_back({.weight = Row::Weight::heading, .name = fmt::format("  {}{}", compare::name(pair.kind()), only)});
  for (const EventField& field : compare::fields_of(pair.kind())) rows.push_back(field_row(pair, field, names));
}

/// The event by one of its fields: the first that differs, if any does.
void add_line(const EventPair& pair, const compare::SceneNames& names, std::vector<Row>& rows) {
  const std::span<const EventField> fields = compare::fields_of(pair.kind());
  if (fields.empty()) return;
  std::size_t differing = 0;
  const EventField* shown = &*std::ranges::find(fields, telling_field(pair.kind()), &EventField::name);
  if (pair.a && pair.b) {
    for (auto field = fields.rbegin(); field != fields.rend(); ++field) {
      if (field->tier == compare::FieldTier::observed || !compare::differs(pair, *field)) continue;
      shown = &*field;
      ++differing;
    }
  }
  Row row = field_row(pair, *shown, names);
  row.name = fmt::format("  {} {}", compare::name(pair.kind()), shown->name);
  if (pair.kind() == EventKind::ray)
    row.name =
        fmt::format("  {} ray", pair.event().words[pathtracer::event_word::ray_kind] == 0 ? "closest" : "shadow");
  if (pair.kind() == EventKind::ray && std::string_view(shown->name) != "answer")
    row.name += fmt::format(" {}", shown->name);
  if (differing > 1) row.note += fmt::format("{}+{} fields", row.note.empty() ? "" : " ", differing - 1);
  rows.push_back(std::move(row));
}

/// A segment is shown whole where the paths part, by a line for each event behind that, and by a line for all before.
std::vector<Row> event_rows(const compare::Explanation& explanation, bool all_events) {
  std::vector<Row> rows;
  const std::span<const EventPair> events = explanation.events;
  const std::size_t first = explanation.first ? explanation.first->pair : events.size();
  for (std::size_t begin = 0; begin < events.size();) {
    const std::uint32_t segment = events[begin].segment();
    std::size_t end = begin;
    while (end < events.size() && events[end].segment() == segment) ++end;
    const std::span<const EventPair> members = events.subspan(begin, end - begin);
    const bool same = std::ranges::none_of(members, [](const EventPair& pair) { return compare::differs(pair); });
    const bool known_same = same && begin < first && explanation.first;
    rows.push_back({.weight = Row::Weight::heading,
                    .name = fmt::format("segment {}{}", segment,
                                        same ? fmt::format(": the same, {} events", members.size()) : "")});
    for (const EventPair& pair : members) {
      if (all_events || (begin <= first && first < end))
        add_whole(pair, explanation.names, rows);
      else if (!known_same)
        add_line(pair, explanation.names, rows);
    }
    begin = end;
  }
  return rows;
}

void print_rows(const std::vector<Row>& rows, bool colors, std::string& text) {
  std::size_t name_width = 0, a_width = 0, b_width = 0;
  for (const Row& row : rows) {
    if (row.weight != Row::Weight::heading) name_width = std::max(name_width, row.name.size());
    if (row.b.empty()) continue;
    a_width = std::max(a_width, row.a.size());
    b_width = std::max(b_width, row.b.size());
  }
  const auto out = std::back_inserter(text);
  for (const Row& row : rows) {
    const char mark = row.weight == Row::Weight::differing ? '*' : row.weight == Row::Weight::observed ? '~' : ' ';
    std::string line = row.b.empty() ? fmt::format("{} {:<{}}  {}", mark, row.name, name_width, row.a)
                                     : fmt::format("{} {:<{}}  {:<{}}  {:<{}}  {}", mark, row.name, name_width, row.a,
                                                   a_width, row.b, b_width, row.note);
    line.erase(line.find_last_not_of(' ') + 1);
    const std::string_view color = colors ? color_of(row.weight) : std::string_view();
    fmt::format_to(out, "{}{}{}\n", color, line, color.empty() ? std::string_view() : usual);
  }
}

/// "samples 3, 7 and 9", "sample 3"
std::string sample_list(std::span<const std::uint32_t> samples) {
  constexpr std::size_t listed = 12;
  std::string text = samples.size() == 1 ? "sample " : "samples ";
  for (std::size_t i = 0; i < std::min(samples.size(), listed); ++i)
    fmt::format_to(std::back_inserter(text), "{}{}", i == 0 ? "" : ", ", samples[i]);
  return text + (samples.size() > listed ? ", ..." : "");
}

std::string pixel_text(const compare::Explanation& explanation) {
  std::vector<std::uint32_t> differing;
  for (const compare::ExplainedSample& sample : explanation.samples)
    if (sample.differs) differing.push_back(sample.sample);
  const std::string pixel = fmt::format("{},{}", explanation.pixel.x, explanation.pixel.y);
  const std::size_t count = explanation.samples.size();
  if (differing.empty() && count == 1)
    return fmt::format("{}: sample {} is the same on both devices", pixel, explanation.samples.front().sample);
  if (differing.empty()) return fmt::format("{}: all {} samples are the same on both devices", pixel, count);
  return fmt::format("{}: {} of {} differ{}: {}", pixel, differing.size(),
                     count == 1 ? "1 sample" : fmt::format("{} samples", count), differing.size() == 1 ? "s" : "",
                     sample_list(differing));
}

std::string path_text(const compare::Explanation& explanation) {
  std::size_t segments_a = 0, segments_b = 0;
  for (const EventPair& pair : explanation.events) {
    segments_a += pair.a && pair.a->kind() == EventKind::segment ? 1u : 0u;
    segments_b += pair.b && pair.b->kind() == EventKind::segment ? 1u : 0u;
  }
  return fmt::format("sample {}, {} segments on a, {} on b", explanation.shown_sample().sample, segments_a, segments_b);
}

using Line = std::function<void(std::string_view name, std::string_view value)>;

void print_first(const compare::Explanation& explanation, const Line& line) {
  const compare::FirstDifference& first = *explanation.first;
  const EventPair& pair = explanation.events[first.pair];
  const std::string event = fmt::format("segment {}, {}", pair.segment(), compare::name(pair.kind()));
  if (first.field == nullptr) {
    line("first difference", fmt::format("{}: on {} only", event, pair.a ? "a" : "b"));
    return;
  }
  line("first difference", fmt::format("{}, {}", event, first.field->name));
  line("  a", explanation.names.text(*first.field, *pair.a));
  line("  b", explanation.names.text(*first.field, *pair.b));
  if (first.ulp_distance != no_distance)
    line("  distance", fmt::format("{} ULP, {:.3g} relative", first.ulp_distance, first.relative_difference));
}

void print_divergences(const compare::Explanation& explanation, const Line& line) {
  const compare::ExplainedSample& shown = explanation.shown_sample();
  if (!shown.classified) return;
  bool later = false;
  for (const compare::Divergence& divergence : shown.classified->divergences) {
    const std::string place =
        fmt::format("{} (segment {}, {}{}{})", compare::name(divergence.difference_class), divergence.segment,
                    compare::name(divergence.a.kind()), divergence.field != nullptr ? ", " : "",
                    divergence.field != nullptr ? divergence.field->name : "");
    line(later ? "then" : "class", later ? place : compare::name(divergence.difference_class));
    line("", divergence.sentence);
    later = true;
  }
  for (const compare::ExplainedSample& sample : explanation.samples) {
    if (&sample == &shown || !sample.classified) continue;
    if (const auto worst = sample.classified->worst())
      line(fmt::format("sample {}", sample.sample), compare::name(*worst));
  }
}

void print_observed(const compare::ObservedDifferences& observed, const Line& line) {
  if (observed.differing == 0) return;
  line("reported",
       fmt::format("t and barycentrics of hits: {} of {} differ, by up to {:.2g}; no result depends on them",
                   observed.differing, observed.fields, observed.relative_difference));
}

}  // namespace

std::string table(const compare::Explanation& explanation, const ExplanationTableOptions& options) {
  std::string text;
  const Line line = [&](std::string_view name, std::string_view value) {
    fmt::format_to(std::back_inserter(text), "{:<18}{}\n", name, value);
  };
  line("scene", scene_text(explanation.job));
  line("settings", settings_text(explanation.job));
  if (const glm::dvec3& origin = explanation.job.origin; origin != glm::dvec3(0))
    line("positions", fmt::format("relative to {},{},{} of the file", origin.x, origin.y, origin.z));
  line("a", fmt::format("{}, {}", explanation.a.name, pathtracer::name(explanation.trace_a)));
  line("b", fmt::format("{}, {}", explanation.b.name, pathtracer::name(explanation.trace_b)));
  line("pixel", pixel_text(explanation));
  line("path shown", path_text(explanation));
  if (explanation.first) print_first(explanation, line);
  print_divergences(explanation, line);
  print_observed(explanation.observed, line);
  text += "\n";
  print_rows(event_rows(explanation, options.all_events), options.colors, text);
  if (explanation.probing) text += "\n" + table(*explanation.probing);
  return text;
}

}  // namespace tandem::tools
