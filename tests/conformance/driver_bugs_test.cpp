#include "conformance/kit/driver_bugs.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

namespace tandem::conformance {
namespace {

TEST_CASE("driver bugs are read whole or refused") {
  const std::vector<DriverBug> bugs = parse_driver_bugs(
      R"([{"driver": "D", "version": "1", "case": "a.b.c", "failure": "f", "reason": "r", "evidence": "e"}])");
  REQUIRE(bugs.size() == 1);
  CHECK(bugs[0].driver == "D");
  CHECK(bugs[0].version == "1");
  CHECK(bugs[0].name == "a.b.c");
  CHECK(bugs[0].failure == "f");
  CHECK(bugs[0].reason == "r");
  CHECK(bugs[0].evidence == "e");
  CHECK(find_driver_bug(bugs, "D 1", "a.b.c") == &bugs[0]);
  CHECK(find_driver_bug(bugs, "D 1-package", "a.b.c") == &bugs[0]);
  CHECK(find_driver_bug(bugs, "D 2", "a.b.c") == &bugs[0]);
  CHECK(find_driver_bug(bugs, "DD 1", "a.b.c") == nullptr);
  CHECK(is_seen_version(bugs[0], "D 1-package"));
  CHECK_FALSE(is_seen_version(bugs[0], "D 2"));
  CHECK(find_driver_bug(bugs, "D", "a.b.c") == nullptr);
  CHECK(find_driver_bug(bugs, "D 1", "a.b.d") == nullptr);
  CHECK_THROWS_AS(parse_driver_bugs("{}"), std::invalid_argument);
  CHECK_THROWS_AS(parse_driver_bugs("["), std::invalid_argument);
  CHECK_THROWS_AS(parse_driver_bugs(R"([{"driver": "D 1", "case": "a.b.c", "failure": "f", "reason": "r"}])"),
                  std::invalid_argument);
  CHECK_THROWS_AS(
      parse_driver_bugs(R"([{"driver": "D 1", "case": "", "failure": "f", "reason": "r", "evidence": "e"}])"),
      std::invalid_argument);
}

}  // namespace
}  // namespace tandem::conformance
