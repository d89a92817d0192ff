#include "rhi_cpu/launch/fibre_set.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <stdexcept>
#include <vector>

namespace tandem::cpu {
namespace {

constexpr std::size_t stack_size = 64 << 10;

struct Log {
  std::uint32_t count = 0;
  std::uint32_t thrower = ~0u;
  std::vector<std::uint32_t> steps = {};
  std::uint32_t ended = 0;
};

/// Counts what has been unwound.
struct Guard {
  explicit Guard(Log& log) : log_(log) {}
  ~Guard() { ++log_.ended; }
  Log& log_;
};

/// Each fibre takes three steps, by turns.
std::uint32_t walk(void* context, kernel::Fibres& fibres, std::uint32_t index) {
  Log& log = *static_cast<Log*>(context);
  const Guard guard(log);
  for (std::uint32_t step = 0; step < 3; ++step) {
    log.steps.push_back(step * 100 + index);
    if (step == 1 && index == log.thrower) throw std::runtime_error("stumbled");
    if (step < 2) fibres.switch_to(fibres, (index + 1) % log.count);
  }
  return index + 1;
}

/// Fills most of a stack.
std::uint32_t fill(void*, kernel::Fibres& fibres, std::uint32_t index) {
  volatile char bytes[200 << 10];
  std::memset(const_cast<char*>(bytes), static_cast<int>(index), sizeof(bytes));
  fibres.switch_to(fibres, 1 - index);
  CHECK(bytes[sizeof(bytes) - 1] == static_cast<char>(index));
  return index + 1;
}

TEST_CASE("fibres run by turns, and are used again") {
  FibreSet set;
  for (const std::uint32_t count : {3u, 5u, 1u}) {
    Log log{.count = count};
    set.run(count, stack_size, walk, &log);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t step = 0; step < 3; ++step)
      for (std::uint32_t i = 0; i < count; ++i) expected.push_back(step * 100 + i);
    CHECK(log.steps == expected);
    CHECK(log.ended == count);
  }
}

TEST_CASE("what a fibre throws arrives, and all fibres are unwound") {
  FibreSet set;
  for (int i = 0; i < 3; ++i) {
    Log log{.count = 6, .thrower = 2};
    CHECK_THROWS_WITH_AS(set.run(6, stack_size, walk, &log), "stumbled", std::runtime_error);
    CHECK(log.steps.back() == 102);
    CHECK(log.ended == 6);
    Log after{.count = 4};
    set.run(4, stack_size, walk, &after);
    CHECK(after.ended == 4);
  }
}

TEST_CASE("a fibre has the stack that it asks for") {
  FibreSet set;
  Log log{.count = 2};
  set.run(2, stack_size, walk, &log);
  set.run(2, 256 << 10, fill, nullptr);
}

}  // namespace
}  // namespace tandem::cpu
