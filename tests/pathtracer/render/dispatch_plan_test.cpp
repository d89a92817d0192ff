#include "pathtracer/render/dispatch_plan.hpp"

#include <algorithm>
#include <vector>

#include <doctest/doctest.h>

using namespace tandem::pathtracer;

TEST_CASE("Tiles cover every pixel once, whatever their size") {
  for (const glm::uvec2 resolution : {glm::uvec2(1, 1), glm::uvec2(33, 19), glm::uvec2(64, 64), glm::uvec2(7, 300)})
    for (const std::uint32_t maximum_side : {0u, 1u, 8u, 20u})
      for (const double pixels : {0.5, 64.0, 1000.0, 1e12}) {
        std::vector<int> covered(resolution.x * resolution.y, 0);
        for (TileCursor cursor(resolution, maximum_side); !cursor.at_end();) {
          const Tile tile = cursor.next(pixels);
          REQUIRE(tile.size.x > 0);
          REQUIRE(tile.size.y > 0);
          for (std::uint32_t y = tile.offset.y; y < tile.offset.y + tile.size.y; ++y)
            for (std::uint32_t x = tile.offset.x; x < tile.offset.x + tile.size.x; ++x) ++covered[y * resolution.x + x];
        }
        CHECK(std::all_of(covered.begin(), covered.end(), [](int count) { return count == 1; }));
      }
}

TEST_CASE("A tile has about the pixels asked for, and keeps to its largest side") {
  TileCursor large({4096, 4096}, 0);
  const Tile rows = large.next(4096 * 100);
  CHECK(rows.size.x == 4096);
  CHECK(rows.size.y == 96);
  TileCursor small({4096, 4096}, 0);
  const Tile piece = small.next(1024);
  CHECK(piece.size.x * piece.size.y == 1024);
  TileCursor bounded({4096, 4096}, 64);
  const Tile tile = bounded.next(1e9);
  CHECK(tile.size.x == 64);
  CHECK(tile.size.y == 64);
}

TEST_CASE("The pace follows a measured speed, down at once and up by steps") {
  Pace pace(0.25);
  const double first = pace.budget();
  CHECK(first > 0);
  pace.measured(1000, 1);  // 1000 a second
  CHECK(pace.budget() == doctest::Approx(250));
  pace.measured(1e9, 1);
  CHECK(pace.budget() == doctest::Approx(1000));
  pace.measured(10, 1);
  CHECK(pace.budget() == doctest::Approx(2.5));
  pace.measured(1, 1000);
  CHECK(pace.budget() == 1);
}
