#include "rhi_vulkan/shader_table.hpp"

#include <doctest/doctest.h>

#include <cstdint>

using tandem::vulkan::place_records;
using tandem::vulkan::RecordPlacement;

TEST_CASE("records whose stride is aligned lie in memory once") {
  std::uint64_t begin = 32;
  const RecordPlacement placement = place_records(128, 5, 64, begin);
  REQUIRE(placement.copies.size() == 1);
  CHECK(placement.aligned_offset(0) == 64);
  CHECK(placement.aligned_offset(3) == 64 + 3 * 128);
  CHECK(begin == 64 + 5 * 128);
}

TEST_CASE("every record is aligned in one of the copies, which lie behind each other") {
  for (const std::uint64_t alignment : {32, 64, 256}) {
    for (const std::uint64_t stride : {16, 32, 48, 64, 80, 96, 4096}) {
      for (const std::uint64_t count : {1, 2, 3, 7, 100}) {
        std::uint64_t begin = 32;
        const RecordPlacement placement = place_records(stride, count, alignment, begin);
        std::uint64_t free = 32;
        for (const std::uint64_t copy : placement.copies) {
          CHECK(copy >= free);
          free = copy + count * stride;
        }
        CHECK(begin == free);
        for (std::uint32_t record = 0; record < count; ++record) {
          const std::uint64_t offset = placement.aligned_offset(record);
          REQUIRE(offset % alignment == 0);
          bool is_that_record = false;
          for (const std::uint64_t copy : placement.copies) is_that_record |= offset == copy + record * stride;
          REQUIRE(is_that_record);
        }
      }
    }
  }
}

TEST_CASE("no records take no memory") {
  std::uint64_t begin = 32;
  CHECK(place_records(32, 0, 64, begin).copies.empty());
  CHECK(begin == 32);
}
