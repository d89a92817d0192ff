#include "rhi_vulkan/dependency_tracker.hpp"

#include <doctest/doctest.h>

#include <array>

using namespace tandem::vulkan;

namespace {

constexpr int a = 0, b = 0;  // two objects; only their addresses matter

Access reads(const int& object, std::uint64_t begin = 0, std::uint64_t end = 10) {
  return {&object, begin, end, false};
}
Access writes(const int& object, std::uint64_t begin = 0, std::uint64_t end = 10) {
  return {&object, begin, end, true};
}

bool transfer(DependencyTracker& tracker, Access access) {
  return tracker.needs_barrier(CommandKind::transfer, std::array{access});
}

}  // namespace

TEST_CASE("the first command waits for the lists before it") {
  DependencyTracker tracker;
  CHECK(transfer(tracker, reads(a)));
}

TEST_CASE("transfers need a barrier between them only where they conflict") {
  DependencyTracker tracker;
  transfer(tracker, writes(a, 0, 10));
  CHECK_FALSE(transfer(tracker, writes(b, 0, 10)));
  CHECK_FALSE(transfer(tracker, reads(a, 10, 20)));
  CHECK_FALSE(transfer(tracker, reads(a, 10, 30)));
  SUBCASE("write after write") { CHECK(transfer(tracker, writes(a, 9, 10))); }
  SUBCASE("read after write") { CHECK(transfer(tracker, reads(b, 0, 1))); }
  SUBCASE("write after read") { CHECK(transfer(tracker, writes(a, 15, 16))); }
  SUBCASE("after a barrier, what was before it is forgotten") {
    CHECK(transfer(tracker, writes(a, 9, 10)));
    CHECK_FALSE(transfer(tracker, reads(b)));
  }
  SUBCASE("when one is asked for") {
    tracker.require_barrier();
    CHECK(transfer(tracker, reads(b, 90, 91)));
    CHECK_FALSE(transfer(tracker, reads(b, 91, 92)));
  }
}

TEST_CASE("another kind of command, and every exclusive one, needs a barrier") {
  DependencyTracker tracker;
  transfer(tracker, writes(a));
  CHECK(tracker.needs_barrier(CommandKind::bottom_level_build, std::array{writes(b)}));
  CHECK(tracker.needs_barrier(CommandKind::bottom_level_build, std::array{writes(b)}));
  CHECK_FALSE(tracker.needs_barrier(CommandKind::bottom_level_build, std::array{writes(a)}));
  CHECK(tracker.needs_barrier(CommandKind::exclusive, {}));
  CHECK(tracker.needs_barrier(CommandKind::exclusive, {}));
  CHECK(transfer(tracker, reads(a)));
}
