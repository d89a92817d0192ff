// What a run of a test program prints and returns, by the example of sample.cpp on two devices.

#include <doctest/doctest.h>

#include <string>
#include <string_view>
#include <vector>

#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using test::Outcome;

namespace {

/// Runs the sample with further variables.
Outcome sample(std::vector<std::string> environment, const std::vector<std::string>& arguments = {}) {
  environment.insert(environment.begin(), "TANDEM_TEST_DEVICES=cpu,cpu-exact");
  return test::run_program(TANDEM_TEST_SAMPLE, arguments, {.environment = std::move(environment)});
}

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

/// The line of doctest that counts test cases, without its colours and columns.
bool counts(const Outcome& outcome, const std::string& passed, const std::string& failed) {
  std::string line;
  for (const char character : outcome.output)
    if (character != ' ') line += character;
  return contains(line, passed + "passed|" + failed + "failed");
}

}  // namespace

TEST_CASE("A device test is one test case per device, named after it") {
  const Outcome outcome = sample({}, {"--list-test-cases"});
  CHECK(outcome.exit_code == 0);
  for (const char* name : {"first [cpu]\n", "first [cpu-exact]\n", "second [cpu]\n", "second [cpu-exact]\n"})
    CHECK(contains(outcome.output, name));
  const Outcome one =
      test::run_program(TANDEM_TEST_SAMPLE, {"--list-test-cases"}, {.environment = {"TANDEM_TEST_DEVICES=cpu"}});
  CHECK(contains(one.output, "first [cpu]\n"));
  CHECK_FALSE(contains(one.output, "cpu-exact"));
}

TEST_CASE("All cases pass on all devices") {
  const Outcome outcome = sample({});
  CAPTURE(outcome.output);
  CHECK(outcome.exit_code == 0);
  CHECK(counts(outcome, "5", "0"));
  CHECK_FALSE(contains(outcome.output, "skipped:"));
  CHECK(outcome.errors == "");
}

TEST_CASE("What fails on one device hides no other one, whether by a check or by an exception") {
  for (const char* failure : {"SAMPLE_FAILS=cpu", "SAMPLE_THROWS=cpu"}) {
    const Outcome outcome = sample({failure});
    CAPTURE(outcome.output);
    CHECK(outcome.exit_code == 1);
    CHECK(counts(outcome, "4", "1"));
    CHECK(contains(outcome.output, "first [cpu]\n"));
    CHECK_FALSE(contains(outcome.output, "first [cpu-exact]\n"));  // doctest names what fails
  }
}

TEST_CASE("Each case can be selected alone") {
  const Outcome other = sample({"SAMPLE_FAILS=cpu"}, {"-tc=first [cpu-exact]"});
  CHECK(other.exit_code == 0);
  CHECK(counts(other, "1", "0"));
  const Outcome failing = sample({"SAMPLE_FAILS=cpu"}, {"-tc=first [cpu]"});
  CHECK(failing.exit_code == 1);
  CHECK(counts(failing, "0", "1"));
}

TEST_CASE("A device that cannot be created fails its own cases alone") {
  const Outcome outcome =
      test::run_program(TANDEM_TEST_SAMPLE, {}, {.environment = {"TANDEM_TEST_DEVICES=absent,cpu"}});
  CAPTURE(outcome.output);
  CHECK(outcome.exit_code == 1);
  CHECK(counts(outcome, "3", "2"));
  CHECK(contains(outcome.output, "second [absent]\n"));
}

TEST_CASE("Messages belong to the case that caused them, even where a check or an exception ends it") {
  const test::ScratchFolder folder;
  const std::string unusable = "TANDEM_CACHE_DIR=" + folder.write("file", "").string();
  for (const char* failure : {"SAMPLE_FAILS=none", "SAMPLE_FAILS=cpu", "SAMPLE_THROWS=cpu"}) {
    const Outcome outcome = sample({unusable, "SAMPLE_WARNS=cpu", failure});
    CAPTURE(outcome.output);
    CHECK(outcome.exit_code == 1);
    CHECK(counts(outcome, "4", "1"));
    CHECK(contains(outcome.output, "first [cpu]\n"));
    CHECK(contains(outcome.output, "cpu kernel cache: "));
    CHECK_FALSE(contains(outcome.output, "second"));
  }
}

TEST_CASE("Skipped cases are printed with their reason and counted") {
  const Outcome outcome = sample({"SAMPLE_SKIPS=cpu"}, {"-tc=first*"});
  CAPTURE(outcome.output);
  CHECK(outcome.exit_code == 0);
  CHECK(contains(outcome.output, "skipped: the sample was told to\n"));
  CHECK(outcome.output.ends_with("1 skipped: the sample was told to\n  first [cpu]\n"));
}

TEST_CASE("A run that only skips says so to CTest") {
  const Outcome outcome = sample({"SAMPLE_SKIPS=cpu"}, {"-tc=first [cpu]"});
  CHECK(outcome.exit_code == 77);
}

TEST_CASE("A device that ran nothing fails the run") {
  const Outcome outcome = sample({"SAMPLE_SKIPS=cpu"});
  CAPTURE(outcome.output);
  CHECK(outcome.exit_code == 1);
  CHECK(counts(outcome, "5", "0"));
  CHECK(outcome.output.ends_with("2 skipped: the sample was told to\n  first [cpu]\n  second [cpu]\n"));
  CHECK(outcome.errors == "Device cpu ran none of its 2 test cases.\n");
}

TEST_CASE("A line is split into words, with values that may have spaces") {
  CHECK(test::words("devices  --json") == std::vector<std::string>{"devices", "--json"});
  CHECK(test::words("render {} --size 8x8 -o {}", {"my scene.obj", "x.png"}) ==
        std::vector<std::string>{"render", "my scene.obj", "--size", "8x8", "-o", "x.png"});
  CHECK_THROWS(test::words("render {}"));
  CHECK_THROWS(test::words("render", {"x"}));
}
