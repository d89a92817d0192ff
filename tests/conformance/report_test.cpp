#include "conformance/kit/report.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace tandem::conformance {
namespace {

std::vector<DeviceReport> sample_reports() {
  DeviceReport report;
  report.device.name = "d:0";
  report.device.description = "hardware";
  report.device.driver = "driver 1";
  report.device.api = "API 2";
  report.results = {{"a.b.good", Status::passed, "", "12 rays"},
                    {"a.b.bad", Status::failed, "t is 1, expected 2", ""},
                    {"a.c.listed", Status::driver_bug, "a | b", ""},
                    {"a.c.missing", Status::unsupported, "the device lacks wings", ""}};
  return {report};
}

std::vector<Case> sample_cases() {
  const auto body = [](Context&) {};
  return {{"a.b.good", "is good", {}, body},
          {"a.b.bad", "is bad", {}, body},
          {"a.c.listed", "is listed", {}, body},
          {"a.c.missing", "is missing", {}, body}};
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_CASE("the text counts by group and says each failure's sentence") {
  const std::string seen = text(sample_reports().front());
  CHECK(contains(seen, "d:0: hardware, driver 1, API 2"));
  CHECK(contains(seen, "failed: a.b.bad: t is 1, expected 2"));
  CHECK(contains(seen, "driver bug: a.c.listed: a | b"));
  CHECK(contains(seen, "the device lacks wings"));
  CHECK(contains(seen, "12 rays"));
  CHECK(contains(seen, "a.c"));
}

TEST_CASE("the JSON holds every result") {
  const nlohmann::ordered_json json = to_json(sample_reports());
  REQUIRE(json["devices"].size() == 1);
  const auto& device = json["devices"][0];
  CHECK(device["succeeded"] == false);
  CHECK(device["counts"]["passed"] == 1);
  CHECK(device["counts"]["driver bug"] == 1);
  REQUIRE(device["results"].size() == 4);
  CHECK(device["results"][1]["name"] == "a.b.bad");
  CHECK(device["results"][1]["status"] == "failed");
  CHECK(device["results"][1]["sentence"] == "t is 1, expected 2");
}

TEST_CASE("the Markdown ends with the catalogue, and cells stay cells") {
  const std::vector<Case> cases = sample_cases();
  const std::vector<DriverBug> bugs = {{"driver", "1", "a.c.listed", "a", "wrong", "the specification"}};
  const std::string seen = markdown(sample_reports(), cases, bugs);
  CHECK(seen.ends_with(catalogue(cases, bugs)));
  CHECK(contains(seen, "| a.b | 1 passed, 1 **failed** |"));
  CHECK(contains(seen, "a \\| b"));
  CHECK(contains(seen, "| driver 1 | a.c.listed | wrong | the specification |"));
  CHECK(contains(seen, "| good | is good |"));
  CHECK(markdown(sample_reports(), cases, bugs) == seen);
}

}  // namespace
}  // namespace tandem::conformance
