#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "conformance/kit/report.hpp"
#include "tests/support/device_test.hpp"

namespace tandem::conformance {
namespace {

/// The devices under test, and the exact one beside the CPU's.
std::vector<std::string> names_of_devices() {
  std::vector<std::string> names = test::device_names();
  const auto cpu = std::find(names.begin(), names.end(), "cpu");
  if (cpu != names.end() && std::find(names.begin(), names.end(), "cpu-exact") == names.end())
    names.insert(cpu + 1, "cpu-exact");
  return names;
}

TEST_CASE("every device passes the kit, but for the known bugs of its driver") {
  const std::vector<Case> cases = all_cases();
  for (const std::string& name : names_of_devices()) {
    SUBCASE(name.c_str()) {
      RunOptions options = {.driver_bugs = known_driver_bugs()};
      options.take_messages = [name] { return test::take_warnings(name); };
      const DeviceReport report = run(*test::device(name), cases, options);
      MESSAGE(text(report));
      for (const Result& result : report.results) {
        if (result.status == Status::failed || result.status == Status::error ||
            result.status == Status::unexpected_pass)
          FAIL_CHECK(name_of(result.status), ": ", result.name, ": ", result.sentence);
      }
      CHECK(succeeded(report));
    }
  }
}

TEST_CASE("docs/results/backend-status.md has the kit's cases and the known driver bugs") {
  std::ifstream file(TANDEM_SOURCE_DIRECTORY "/docs/results/backend-status.md");
  std::ostringstream status;
  status << file.rdbuf();
  const bool up_to_date = status.str().ends_with(catalogue(all_cases(), known_driver_bugs()));
  CHECK_MESSAGE(up_to_date, "make it again: tandem conformance --markdown docs/results/backend-status.md");
}

}  // namespace
}  // namespace tandem::conformance
