#include "conformance/kit/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

namespace tandem::conformance {
namespace {

constexpr Status all_statuses[] = {Status::passed,     Status::failed,          Status::error,
                                   Status::driver_bug, Status::unexpected_pass, Status::unsupported};

struct Counts {
  std::map<Status, std::size_t> of;

  std::size_t wrong() const { return get(Status::failed) + get(Status::error) + get(Status::unexpected_pass); }
  std::size_t get(Status status) const {
    const auto found = of.find(status);
    return found == of.end() ? 0 : found->second;
  }
};

/// Groups in the order in which they first appear.
template <typename Named>
std::vector<std::string_view> groups_of(std::span<const Named> named) {
  std::vector<std::string_view> groups;
  for (const Named& entry : named)
    if (std::find(groups.begin(), groups.end(), group_of(entry.name)) == groups.end())
      groups.push_back(group_of(entry.name));
  return groups;
}

Counts count_group(const DeviceReport& report, std::string_view group) {
  Counts counts;
  for (const Result& result : report.results)
    if (group_of(result.name) == group) ++counts.of[result.status];
  return counts;
}

Counts count_all(const DeviceReport& report) {
  Counts counts;
  for (const Result& result : report.results) ++counts.of[result.status];
  return counts;
}

std::string text_row(std::string_view name, const Counts& counts) {
  return fmt::format("  {:<44} {:>6} {:>6} {:>6} {:>11}\n", name, counts.get(Status::passed), counts.wrong(),
                     counts.get(Status::driver_bug), counts.get(Status::unsupported));
}

std::string device_line(const rhi::DeviceInfo& device) {
  return fmt::format("{}: {}, {}{}{}", device.name, device.description, device.driver, device.api.empty() ? "" : ", ",
                     device.api);
}

/// "12 passed, 1 driver bugs", "-" when nothing ran.
std::string cell(const Counts& counts) {
  std::string cell;
  const auto add = [&](std::size_t number, std::string_view what) {
    if (number > 0) cell += fmt::format("{}{} {}", cell.empty() ? "" : ", ", number, what);
  };
  add(counts.get(Status::passed), "passed");
  add(counts.wrong(), "**failed**");
  add(counts.get(Status::driver_bug), counts.get(Status::driver_bug) == 1 ? "driver bug" : "driver bugs");
  add(counts.get(Status::unsupported), "unsupported");
  return cell.empty() ? "-" : cell;
}

/// Sentences come from drivers too: what would end a table's cell is escaped.
std::string in_table(std::string_view text) {
  std::string escaped;
  for (const char character : text) {
    if (character == '|') escaped += '\\';
    escaped += character == '\n' ? ' ' : character;
  }
  return escaped;
}

std::string device_table(std::span<const DeviceReport> reports) {
  std::string table = "| group |";
  std::string rule = "|---|";
  for (const DeviceReport& report : reports) {
    table += fmt::format(" {} |", report.device.name);
    rule += "---|";
  }
  table += fmt::format("\n{}\n", rule);
  const auto row = [&](std::string_view name, const auto& counts_of) {
    table += fmt::format("| {} |", name);
    for (const DeviceReport& report : reports) table += fmt::format(" {} |", cell(counts_of(report)));
    table += "\n";
  };
  if (reports.empty()) return table;
  for (const std::string_view group : groups_of(std::span(reports.front().results)))
    row(group, [group](const DeviceReport& report) { return count_group(report, group); });
  row("**all**", count_all);
  return table;
}

std::string result_list(std::span<const DeviceReport> reports, std::string_view heading, auto&& selects,
                        auto&& sentence_of) {
  std::string list;
  for (const DeviceReport& report : reports)
    for (const Result& result : report.results)
      if (selects(result))
        list += fmt::format("| {} | {} | {} |\n", report.device.name, result.name, in_table(sentence_of(result)));
  if (list.empty()) return {};
  return fmt::format("\n## {}\n\n| device | case | |\n|---|---|---|\n{}", heading, list);
}

}  // namespace

std::string text(const DeviceReport& report) {
  std::string text = device_line(report.device) + "\n";
  text += fmt::format("  {:<44} {:>6} {:>6} {:>6} {:>11}\n", "group", "passed", "failed", "bugs", "unsupported");
  for (const std::string_view group : groups_of(std::span(report.results)))
    text += text_row(group, count_group(report, group));
  text += text_row("all", count_all(report));
  // Many cases may need the same that is missing: one line for each reason.
  std::map<std::pair<Status, std::string>, std::vector<std::string_view>> reasons;
  for (const Result& result : report.results)
    if (result.status != Status::passed) reasons[{result.status, result.sentence}].push_back(result.name);
  for (const auto& [reason, names] : reasons)
    text += fmt::format("  {}: {}{}: {}\n", name_of(reason.first), names.front(),
                        names.size() == 1 ? "" : fmt::format(" and {} more", names.size() - 1), reason.second);
  for (const Result& result : report.results)
    if (!result.note.empty()) text += fmt::format("  note: {}: {}\n", result.name, result.note);
  if (count(report, Status::passed) == 0) text += "  no case passed\n";
  return text;
}

nlohmann::ordered_json to_json(std::span<const DeviceReport> reports) {
  nlohmann::ordered_json devices = nlohmann::ordered_json::array();
  for (const DeviceReport& report : reports) {
    nlohmann::ordered_json counts;
    for (const Status status : all_statuses) counts[std::string(name_of(status))] = count(report, status);
    nlohmann::ordered_json results = nlohmann::ordered_json::array();
    for (const Result& result : report.results) {
      nlohmann::ordered_json entry = {{"name", result.name}, {"status", name_of(result.status)}};
      if (!result.sentence.empty()) entry["sentence"] = result.sentence;
      if (!result.note.empty()) entry["note"] = result.note;
      results.push_back(std::move(entry));
    }
    devices.push_back({{"device", report.device.name},
                       {"description", report.device.description},
                       {"driver", report.device.driver},
                       {"api", report.device.api},
                       {"succeeded", succeeded(report)},
                       {"counts", std::move(counts)},
                       {"results", std::move(results)}});
  }
  return {{"devices", std::move(devices)}};
}

std::string markdown(std::span<const DeviceReport> reports, std::span<const Case> cases,
                     std::span<const DriverBug> driver_bugs) {
  std::string text =
      "# Backend status\n\nWhat each device answers to the conformance kit. Made by `tandem conformance --markdown "
      "docs/results/backend-status.md`; do not edit.\n\n";
  for (const DeviceReport& report : reports) text += fmt::format("- {}\n", device_line(report.device));
  text += fmt::format("\n{}", device_table(reports));
  text += result_list(
      reports, "Failures",
      [](const Result& result) {
        return result.status == Status::failed || result.status == Status::error ||
               result.status == Status::unexpected_pass;
      },
      [](const Result& result) { return result.sentence; });
  text += result_list(
      reports, "Driver bugs that were met", [](const Result& result) { return result.status == Status::driver_bug; },
      [](const Result& result) { return result.sentence; });
  text += result_list(
      reports, "Unsupported", [](const Result& result) { return result.status == Status::unsupported; },
      [](const Result& result) { return result.sentence; });
  text += result_list(
      reports, "Counts", [](const Result& result) { return !result.note.empty(); },
      [](const Result& result) { return result.note; });
  return fmt::format("{}\n{}", text, catalogue(cases, driver_bugs));
}

std::string catalogue(std::span<const Case> cases, std::span<const DriverBug> driver_bugs) {
  std::string text = "## Known driver bugs\n\n";
  if (driver_bugs.empty()) text += "None.\n";
  if (!driver_bugs.empty()) text += "| driver | case | what is wrong | evidence |\n|---|---|---|---|\n";
  for (const DriverBug& bug : driver_bugs)
    text += fmt::format("| {} | {} | {} | {} |\n", in_table(bug.driver + " " + bug.version), bug.name,
                        in_table(bug.reason), in_table(bug.evidence));
  text += fmt::format("\n## The {} cases\n", cases.size());
  for (const std::string_view group : groups_of(cases)) {
    text += fmt::format("\n### {}\n\n| case | what must be true |\n|---|---|\n", group);
    for (const Case& test : cases)
      if (group_of(test.name) == group)
        text += fmt::format("| {} | {} |\n", test.name.substr(group.size() + 1), in_table(test.behaviour));
  }
  return text;
}

}  // namespace tandem::conformance
