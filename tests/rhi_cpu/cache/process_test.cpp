#include "rhi_cpu/cache/process.hpp"

#include <doctest/doctest.h>

namespace tandem::cpu {

TEST_CASE("A process gives its exit code and both outputs") {
  const auto result = run_process({"/bin/sh", "-c", "echo out; echo error >&2; exit 7"});
  REQUIRE(result);
  CHECK(result->exit_code == 7);
  CHECK(result->output == "out\nerror\n");
}

TEST_CASE("No shell interprets the arguments of a process") {
  const auto result = run_process({"/bin/echo", "a b", "$HOME", "'; exit 1 #", ""});
  REQUIRE(result);
  CHECK(result->output == "a b $HOME '; exit 1 # \n");
}

TEST_CASE("More output than a pipe holds does not block a process") {
  const auto result = run_process({"/bin/sh", "-c", "head -c 1000000 /dev/zero | tr '\\0' x"});
  REQUIRE(result);
  CHECK(result->output == std::string(1000000, 'x'));
}

TEST_CASE("A process that reads gets the end of its input, not the terminal") {
  const auto result = run_process({"/bin/cat"});
  REQUIRE(result);
  CHECK(result->exit_code == 0);
}

TEST_CASE("A process that a signal ends, and one that does not exist") {
  const auto killed = run_process({"/bin/sh", "-c", "kill -9 $$"});
  REQUIRE(killed);
  CHECK(killed->exit_code == 128 + 9);
  CHECK_FALSE(run_process({"/nonexistent/program"}));
}

}  // namespace tandem::cpu
