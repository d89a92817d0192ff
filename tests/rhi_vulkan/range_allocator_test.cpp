#include "rhi_vulkan/range_allocator.hpp"

#include <doctest/doctest.h>

#include <map>
#include <random>

using tandem::vulkan::RangeAllocator;

TEST_CASE("ranges are aligned, fit exactly, and merge when they come back") {
  RangeAllocator ranges(256);
  CHECK(ranges.empty());
  CHECK(ranges.allocate(10, 1) == 0);
  CHECK(ranges.allocate(32, 64) == 64);
  CHECK(ranges.allocate(160, 32) == 96);
  CHECK(ranges.allocate(55, 1) == std::nullopt);
  CHECK(ranges.allocate(54, 1) == 10);
  CHECK(ranges.allocate(1, 1) == std::nullopt);
  ranges.free(64, 32);
  ranges.free(10, 54);
  CHECK(ranges.allocate(86, 2) == 10);
  ranges.free(96, 160);
  ranges.free(0, 10);
  ranges.free(10, 86);
  CHECK(ranges.empty());
  CHECK(ranges.allocate(256, 256) == 0);
}

TEST_CASE("the smallest hole that fits is taken") {
  RangeAllocator ranges(100);
  REQUIRE(ranges.allocate(40, 1) == 0);
  REQUIRE(ranges.allocate(10, 1) == 40);
  REQUIRE(ranges.allocate(20, 1) == 50);
  REQUIRE(ranges.allocate(30, 1) == 70);
  ranges.free(0, 40);
  ranges.free(50, 20);
  CHECK(ranges.allocate(15, 1) == 50);
}

TEST_CASE("random traffic: no two ranges overlap, and nothing is lost") {
  constexpr std::uint64_t size = 1 << 16;
  RangeAllocator ranges(size);
  std::map<std::uint64_t, std::uint64_t> live;  // offset to size
  std::mt19937 random(1);
  bool sound = true;
  for (int step = 0; step < 20000; ++step) {
    if (random() % 2 == 0 || live.empty()) {
      const std::uint64_t wanted = 1 + random() % 900;
      const std::uint64_t alignment = std::uint64_t{1} << (random() % 9);
      const std::optional<std::uint64_t> offset = ranges.allocate(wanted, alignment);
      if (!offset) continue;
      const auto next = live.lower_bound(*offset);
      sound &= *offset % alignment == 0 && *offset + wanted <= size;
      sound &= next == live.end() || *offset + wanted <= next->first;
      sound &= next == live.begin() || std::prev(next)->first + std::prev(next)->second <= *offset;
      live.emplace(*offset, wanted);
    } else {
      const auto victim = std::next(live.begin(), static_cast<std::ptrdiff_t>(random() % live.size()));
      ranges.free(victim->first, victim->second);
      live.erase(victim);
    }
  }
  CHECK(sound);
  for (const auto& [offset, length] : live) ranges.free(offset, length);
  CHECK(ranges.empty());
}
