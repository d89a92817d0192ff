// docs/schema/diff.schema.json against what 'tandem diff --json' writes, with every optional part.

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/pathtracer/load/description/json_schema.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

using Json = nlohmann::json;

const std::string box = TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj";

const JsonSchema& schema() {
  static const JsonSchema document(Json::parse(read_text(TANDEM_SOURCE_DIRECTORY "/docs/schema/diff.schema.json")));
  return document;
}

Json diff(const ScratchFolder& folder, const std::vector<std::string>& more) {
  const std::vector<std::string> names = device_names();
  std::vector<std::string> words = {"diff",       box,      "--a",   names.front(), "--b",
                                    names.back(), "--size", "16x16", "--json",      "x.json"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = run_tandem(words, {.folder = folder.path()});
  CAPTURE(outcome.errors);
  REQUIRE(outcome.exit_code <= 1);
  Json report = Json::parse(read_text(folder.path() / "x.json"));
  return report;
}

/// The members of the report's parts that the schema does not describe.
std::vector<std::string> undescribed(const Json& report) {
  const auto& root = schema().root();
  std::vector<std::string> names;
  for (const auto& [key, value] : report.items()) {
    if (!root.at("properties").contains(key)) {
      names.push_back(key);
      continue;
    }
    const Json& part = schema().resolve(root.at("properties").at(key), value);
    if (!value.is_object() || !part.contains("properties")) continue;
    for (const auto& [member, inner] : value.items())
      if (!part.at("properties").contains(member)) names.push_back(key + "." + member);
  }
  return names;
}

TEST_CASE("the schema accepts diff.json with metrics, classes, probes and a baseline, and describes every member") {
  const ScratchFolder folder;
  diff(folder, {"--spp", "1", "--out", "run"});
  const Json report = diff(
      folder, {"--spp", "1", "--metrics", "all", "--classify", "--probe", "--probe-rays", "50", "--baseline", "run"});
  CHECK(schema().accepts(report));
  CHECK(undescribed(report) == std::vector<std::string>{});
  for (const char* part : {"metrics", "classification", "probes", "baseline"}) CHECK(report.contains(part));
}

TEST_CASE("the schema accepts diff.json of tier statistical, and describes every member") {
  const ScratchFolder folder;
  const Json report = diff(folder, {"--spp", "16", "--tier", "statistical"});
  CHECK(schema().accepts(report));
  CHECK(undescribed(report) == std::vector<std::string>{});
  CHECK(report.contains("statistics"));
}

TEST_CASE("the schema refuses diff.json without one of its required members, or of another format") {
  const ScratchFolder folder;
  const Json report = diff(folder, {"--spp", "1"});
  REQUIRE(schema().accepts(report));
  for (const Json& key : schema().root().at("required")) {
    Json spoilt = report;
    spoilt.erase(key.get<std::string>());
    CAPTURE(key);
    CHECK_FALSE(schema().accepts(spoilt));
  }
  Json spoilt = report;
  spoilt["format"] = 2;
  CHECK_FALSE(schema().accepts(spoilt));
  spoilt = report;
  spoilt["bit_equal"] = 1.5;
  CHECK_FALSE(schema().accepts(spoilt));
}

}  // namespace
}  // namespace tandem::test
