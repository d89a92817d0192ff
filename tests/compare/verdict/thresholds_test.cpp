#include "compare/verdict/thresholds.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "base/error.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::compare {
namespace {

/// Thresholds of a scene with this file beside it.
Thresholds read(const std::string& text) {
  const test::ScratchFolder folder;
  folder.write("box.thresholds.json", text);
  return thresholds_of(folder.path() / "box.obj");
}

/// What is said of the file, from its name on.
std::string complaint(const std::string& text) {
  try {
    read(text);
  } catch (const tandem::Error& error) {
    const std::string sentence = error.what();
    REQUIRE(sentence.find("box.thresholds.json") != std::string::npos);
    return sentence.substr(sentence.find("box.thresholds.json"));
  }
  return "";
}

TEST_CASE("a scene without a file has the usual thresholds, each with a reason") {
  Thresholds usual;
  usual.set({RuleMetric::bit_equal, 0.5, "as usual"});
  const Thresholds thresholds = thresholds_of("absent.obj", usual);
  CHECK(thresholds.tier == Tier::tolerance);
  CHECK(thresholds.limit(RuleMetric::bit_equal) == 0.5);
  CHECK(thresholds.limit(RuleMetric::within_1e3) == 0.99);
  for (const auto& named : rule_metric_names()) CHECK_FALSE(thresholds.rule(named.value).reason.empty());
}

TEST_CASE("the file beside a scene changes what it names, exactly") {
  CHECK(thresholds_file("a/b.c.json") == std::filesystem::path("a/b.c.thresholds.json"));
  const Thresholds thresholds = read(R"({"tier": "statistical", "rules": [
    {"metric": "bit_equal", "limit": 0.7, "reason": "its edges"}, {"metric": "non_finite", "limit": 3, "reason": "x"}]})");
  CHECK(thresholds.tier == Tier::statistical);
  CHECK(thresholds.limit(RuleMetric::bit_equal) == 0.7);
  CHECK(thresholds.rule(RuleMetric::bit_equal).reason == "its edges");
  CHECK(thresholds.limit(RuleMetric::non_finite) == 3);
  CHECK(thresholds.limit(RuleMetric::within_1e3) == 0.99);
  CHECK(read("{}").rules.size() == rule_metric_names().size());
}

TEST_CASE("what is wrong with a file of thresholds is named with its place") {
  const auto rule = [](const std::string& members) { return complaint(R"({"rules": [{)" + members + "}]}"); };
  CHECK(rule(R"("metric": "bit_equal", "limit": 0.7)") == "box.thresholds.json: rules[0] must have a reason");
  CHECK(rule(R"("metric": "bit_equal", "limit": 0.7, "reason": "")") ==
        "box.thresholds.json: rules[0].reason must not be empty");
  CHECK(rule(R"("metric": "bit_equal", "limit": 1.5, "reason": "x")") ==
        "box.thresholds.json: rules[0].limit must be a number from 0 to 1");
  CHECK(rule(R"("metric": "non_finite", "limit": 0.5, "reason": "x")") ==
        "box.thresholds.json: rules[0].limit must be a whole number from 0 to 4294967295");
  CHECK(rule(R"("metric": "beauty", "limit": 0.5, "reason": "x")").find("rules[0].metric is 'beauty'") !=
        std::string::npos);
  CHECK(rule(R"("metric": "bit_equal", "limit": 1, "reason": "x", "why": 1)").find("rules[0].why is not known") !=
        std::string::npos);
  CHECK(
      rule(R"("metric": "bit_equal", "limit": 1, "reason": "x"}, {"metric": "bit_equal", "limit": 1, "reason": "x")") ==
      "box.thresholds.json: rules[1] limits what another rule limits");
  CHECK(complaint(R"({"tear": "exact"})").find("tear is not known") != std::string::npos);
  CHECK(complaint(R"({"tier": "strict"})").find("tier is 'strict'") != std::string::npos);
  CHECK_FALSE(complaint("{").empty());
}

}  // namespace
}  // namespace tandem::compare
