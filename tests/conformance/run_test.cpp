#include "conformance/kit/run.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "conformance/kit/check.hpp"
#include "tests/support/device_test.hpp"

namespace tandem::conformance {
namespace {

Case passing(const std::string& name) {
  return {.name = name, .behaviour = "passes", .needs = {}, .run = [](Context&) {}};
}

Case failing(const std::string& name) {
  return {.name = name, .behaviour = "fails", .needs = {}, .run = [](Context&) { check_equal("the answer", 41, 42); }};
}

DeviceReport run_on_cpu(const std::vector<Case>& cases, const RunOptions& options = {}) {
  return run(*test::device("cpu"), cases, options);
}

TEST_CASE("a case passes, or fails with what was expected and what came") {
  const DeviceReport report = run_on_cpu({passing("a.b.c"), failing("a.b.d")});
  REQUIRE(report.results.size() == 2);
  CHECK(report.results[0].status == Status::passed);
  CHECK(report.results[0].sentence.empty());
  CHECK(report.results[1].status == Status::failed);
  CHECK(report.results[1].sentence == "the answer is 41, expected 42");
  CHECK_FALSE(succeeded(report));
  CHECK(succeeded(run_on_cpu({passing("a.b.c")})));
}

TEST_CASE("a case whose capability the device lacks does not run, and names it") {
  Case test = failing("a.b.c");
  test.needs = {&rhi::Capabilities::ray_query, &rhi::Capabilities::position_fetch};
  REQUIRE_FALSE(test::device("cpu")->info().capabilities.position_fetch);
  const DeviceReport report = run_on_cpu({test});
  CHECK(report.results[0].status == Status::unsupported);
  CHECK(report.results[0].sentence == "the device lacks position_fetch");
  CHECK_FALSE(succeeded(report));  // no case passed
}

TEST_CASE("a case may find out by itself that a limit is too small") {
  Case test = passing("a.b.c");
  test.run = [](Context&) { throw Unsupported("the device's limit is 1"); };
  CHECK(run_on_cpu({test}).results[0].status == Status::unsupported);
}

TEST_CASE("an exception of the device is an error with its sentence, and the run goes on") {
  Case test = passing("a.b.c");
  test.run = [](Context& context) { context.device().create_buffer({.size = 0, .label = "nothing"}); };
  const DeviceReport report = run_on_cpu({test, passing("a.b.d")});
  CHECK(report.results[0].status == Status::error);
  CHECK(report.results[0].sentence.starts_with("nothing: "));
  CHECK(report.results[1].status == Status::passed);
  CHECK_FALSE(succeeded(report));
}

TEST_CASE("a run without a case that passed has not succeeded") { CHECK_FALSE(succeeded(run_on_cpu({}))); }

TEST_CASE("a known driver bug runs, and is a failure when it passes or fails otherwise") {
  const std::string driver = test::device("cpu")->info().driver;
  const std::size_t blank = driver.rfind(' ');
  const DriverBug bug = {
      driver.substr(0, blank), driver.substr(blank + 1), "a.b.c", "is 41", "it cannot count", "arithmetic"};
  const std::vector<DriverBug> bugs = {bug};
  const RunOptions options = {.driver_bugs = bugs};
  const DeviceReport as_listed = run_on_cpu({failing("a.b.c"), passing("a.b.d")}, options);
  CHECK(as_listed.results[0].status == Status::driver_bug);
  CHECK(as_listed.results[0].sentence == "the answer is 41, expected 42");
  CHECK(succeeded(as_listed));
  const DeviceReport fixed = run_on_cpu({passing("a.b.c")}, options);
  CHECK(fixed.results[0].status == Status::unexpected_pass);
  CHECK_FALSE(succeeded(fixed));

  std::vector<DriverBug> other = {bug};
  other[0].failure = "is 43";
  CHECK(run_on_cpu({failing("a.b.c")}, {.driver_bugs = other}).results[0].status == Status::failed);
  other[0] = bug;
  other[0].driver = "another driver";
  CHECK(run_on_cpu({failing("a.b.c")}, {.driver_bugs = other}).results[0].status == Status::failed);
  other[0] = bug;
  other[0].version = "of another version";
  CHECK(run_on_cpu({failing("a.b.c")}, {.driver_bugs = other}).results[0].status == Status::driver_bug);
  CHECK(run_on_cpu({passing("a.b.c")}, {.driver_bugs = other}).results[0].status == Status::passed);
}

TEST_CASE("a case during which the device complained fails") {
  RunOptions options;
  options.take_messages = [] { return std::vector<std::string>{"layer: a rule is broken"}; };
  const DeviceReport report = run_on_cpu({passing("a.b.c")}, options);
  CHECK(report.results[0].status == Status::failed);
  CHECK(report.results[0].sentence == "the device said: layer: a rule is broken");
}

TEST_CASE("checks of numbers accept the tolerance and no more") {
  check_close("t", 3.00002, 3.0);
  CHECK_THROWS_AS(check_close("t", 3.00004, 3.0), Failure);
  CHECK_THROWS_AS(check_close("t", std::nan(""), 3.0), Failure);
  CHECK_THROWS_AS(check_close("t", 3.0, std::nan("")), Failure);
  check_close("u", 0.250005, 0.25, 1);
  CHECK_THROWS_AS(check_close("u", 0.250005, 0.25), Failure);
}

TEST_CASE("every case has a name of three parts of its own, a sentence and a body") {
  const std::vector<Case> cases = all_cases();
  std::set<std::string> names;
  for (const Case& test : cases) {
    CAPTURE(test.name);
    CHECK(std::regex_match(test.name, std::regex("[a-z0-9_]+\\.[a-z0-9_]+\\.[a-z0-9_]+")));
    CHECK(names.insert(test.name).second);
    CHECK_FALSE(test.behaviour.empty());
    CHECK_FALSE(test.behaviour.ends_with('.'));
    CHECK(test.run != nullptr);
    for (const Capability needed : test.needs) CHECK(name_of(needed) != "a capability without a name");
  }
}

TEST_CASE("every known driver bug is of a case of the kit") {
  const std::vector<Case> cases = all_cases();
  for (const DriverBug& bug : known_driver_bugs()) {
    CAPTURE(bug.name);
    CHECK(std::any_of(cases.begin(), cases.end(), [&](const Case& test) { return test.name == bug.name; }));
  }
}

}  // namespace
}  // namespace tandem::conformance
