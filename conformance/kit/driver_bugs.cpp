#include "conformance/kit/driver_bugs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "known_driver_bugs.hpp"

namespace tandem::conformance {
namespace {

std::string member(const nlohmann::json& entry, const char* name) {
  const auto found = entry.find(name);
  if (found == entry.end() || !found->is_string() || found->get_ref<const std::string&>().empty())
    throw std::invalid_argument(fmt::format("a known driver bug lacks the text '{}': {}", name, entry.dump()));
  return found->get<std::string>();
}

}  // namespace

std::vector<DriverBug> parse_driver_bugs(std::string_view json) {
  const nlohmann::json entries = nlohmann::json::parse(json, nullptr, /*allow_exceptions=*/false);
  if (!entries.is_array()) throw std::invalid_argument("the known driver bugs are not a JSON array");
  std::vector<DriverBug> bugs;
  for (const nlohmann::json& entry : entries) {
    bugs.push_back({.driver = member(entry, "driver"),
                    .version = member(entry, "version"),
                    .name = member(entry, "case"),
                    .failure = member(entry, "failure"),
                    .reason = member(entry, "reason"),
                    .evidence = member(entry, "evidence")});
  }
  return bugs;
}

const std::vector<DriverBug>& known_driver_bugs() {
  static const std::vector<DriverBug> bugs = parse_driver_bugs(known_driver_bugs_json);
  return bugs;
}

const DriverBug* find_driver_bug(std::span<const DriverBug> bugs, std::string_view driver, std::string_view case_name) {
  const auto found = std::find_if(bugs.begin(), bugs.end(), [&](const DriverBug& bug) {
    return driver.starts_with(bug.driver + ' ') && bug.name == case_name;
  });
  return found == bugs.end() ? nullptr : &*found;
}

bool is_seen_version(const DriverBug& bug, std::string_view driver) {
  return driver.starts_with(bug.driver + ' ' + bug.version);
}

}  // namespace tandem::conformance
