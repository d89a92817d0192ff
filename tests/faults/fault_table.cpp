#include "tests/faults/fault_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace tandem::test {
namespace {

constexpr std::size_t column_count = 7;
using Cells = std::array<std::string, column_count>;

const Cells titles = {"fault", "scene", "found by", "class", "bounce", "where", "as declared"};

std::string class_of(const Finding& finding) { return finding.worst ? compare::name(*finding.worst) : ""; }

std::string place_of(const Finding& finding) {
  return finding.field.empty() ? finding.event : fmt::format("{}: {}", finding.event, finding.field);
}

Cells cells_of(const FaultRow& row) {
  const Finding& finding = row.finding;
  return {row.fault.name,
          row.fault.scene,
          name(finding.found_by),
          class_of(finding),
          finding.segment ? fmt::format("{}", *finding.segment) : "",
          place_of(finding),
          finding.problem.empty() ? "yes" : "NO: " + finding.problem};
}

}  // namespace

std::string summary(std::span<const FaultRow> rows) {
  struct Count {
    std::size_t right = 0, all = 0;
  };
  Count harmful, harmless, controls;
  for (const FaultRow& row : rows) {
    const bool is_control = row.fault.name.starts_with("none");
    Count& count = row.fault.harmful ? harmful : is_control ? controls : harmless;
    count.all += 1;
    if (row.finding.problem.empty()) count.right += 1;
  }
  return fmt::format(
      "{} of {} harmful faults are detected, in the right class, bounce and field; {} of {} harmless faults and {} of "
      "{} unmodified controls are accepted",
      harmful.right, harmful.all, harmless.right, harmless.all, controls.right, controls.all);
}

std::string text_table(std::span<const FaultRow> rows) {
  std::vector<Cells> lines = {titles};
  for (const FaultRow& row : rows) lines.push_back(cells_of(row));
  std::array<std::size_t, column_count> widths{};
  for (const Cells& line : lines)
    for (std::size_t i = 0; i < column_count; ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string table;
  for (const Cells& line : lines) {
    std::string text;
    for (std::size_t i = 0; i < column_count; ++i) text += fmt::format("{:{}}  ", line[i], widths[i]);
    table += text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
  }
  return table;
}

std::string markdown_page(std::span<const FaultRow> rows) {
  std::string page = fmt::format(
      R"(# Faults that a comparison finds

Written by `tandem_faults --format markdown`, which injects one fault after another into a device (`tests/faults`: edits
of its SPIR-V, builds, uploads and commands) and compares it with the same device without the fault. A harmful fault must
be detected as a mismatch, at the bounce (0: the camera's segment) and in the field where it acts; a harmless one must be
accepted, and so must the controls (`none...`), in which nothing is changed. *Found by* is the first part of the
comparison that detects the fault: `picture` (pixels differ), `survey` (pixels agree, recorded paths differ) or `probes`
(only the probes' rays differ). *Where* is the event and its field, or the probe's trial.

{}.

| fault | what the device does | scene | found by | class | bounce | where |
|---|---|---|---|---|---|---|
)",
      summary(rows));
  for (const FaultRow& row : rows) {
    const Cells cells = cells_of(row);
    page += fmt::format("| {} | {} | {} | {} | {} | {} | {}{} |\n", cells[0], row.fault.meaning, cells[1], cells[2],
                        cells[3], cells[4], cells[5], row.finding.problem.empty() ? "" : " (" + cells[6] + ")");
  }
  return page;
}

nlohmann::ordered_json to_json(std::span<const FaultRow> rows) {
  nlohmann::ordered_json faults = nlohmann::ordered_json::array();
  for (const FaultRow& row : rows) {
    const Finding& finding = row.finding;
    nlohmann::ordered_json fault = {{"fault", row.fault.name},
                                    {"meaning", row.fault.meaning},
                                    {"scene", row.fault.scene},
                                    {"trace", pathtracer::name(row.fault.form)},
                                    {"harmful", row.fault.harmful},
                                    {"found_by", name(finding.found_by)},
                                    {"class", finding.worst ? nlohmann::ordered_json(class_of(finding)) : nullptr},
                                    {"bounce", finding.segment ? nlohmann::ordered_json(*finding.segment) : nullptr},
                                    {"event", finding.event},
                                    {"field", finding.field},
                                    {"sentence", finding.sentence},
                                    {"differing_pixels", finding.differing_pixels},
                                    {"ok", finding.problem.empty()},
                                    {"problem", finding.problem},
                                    {"seconds", finding.seconds}};
    faults.push_back(std::move(fault));
  }
  return {{"summary", summary(rows)}, {"faults", faults}};
}

}  // namespace tandem::test
