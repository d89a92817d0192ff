#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "conformance/kit/report.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/run_summary.hpp"

namespace tandem::conformance {
namespace {

void check_kit(const std::string& name) {
  RunOptions options = {.driver_bugs = known_driver_bugs()};
  options.take_messages = [name] { return test::take_warnings(name); };
  const DeviceReport report = run(*test::device(name), all_cases(), options);
  MESSAGE(text(report));
  for (const Result& result : report.results) {
    if (result.status == Status::failed || result.status == Status::error || result.status == Status::unexpected_pass)
      FAIL_CHECK(name_of(result.status), ": ", result.name, ": ", result.sentence);
  }
  CHECK(succeeded(report));
}

TANDEM_DEVICE_TEST("every device passes the kit, but for the known bugs of its driver") { check_kit(device_name); }

TEST_CASE("the exact device passes the kit where the CPU is under test") {
  const std::vector<std::string>& names = test::device_names();
  if (std::ranges::count(names, "cpu-exact") != 0) TANDEM_SKIP("cpu-exact is itself under test");
  if (std::ranges::count(names, "cpu") == 0) TANDEM_SKIP("cpu is not under test");
  check_kit("cpu-exact");
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
