#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "compare/cause/pixel_selection.hpp"

namespace tandem::compare {
namespace {

std::set<std::uint64_t> places(const std::vector<SelectedPixel>& pixels) {
  std::set<std::uint64_t> result;
  for (const SelectedPixel& each : pixels) result.insert(row_order(each.pixel));
  return result;
}

TEST_CASE("every pixel that differs is selected once, and the survey besides") {
  const std::vector<glm::uvec2> differing = {{3, 0}, {0, 7}, {15, 7}};
  const std::vector<SelectedPixel> pixels = select_pixels(differing, 16, 8, 32);
  CHECK(places(pixels).size() == pixels.size());
  CHECK(std::ranges::count_if(pixels, &SelectedPixel::differs) == 3);
  CHECK(std::ranges::count_if(pixels, &SelectedPixel::surveyed) == 32);
  for (const SelectedPixel& each : pixels) {
    CHECK(each.pixel.x < 16);
    CHECK(each.pixel.y < 8);
    const bool differs = std::ranges::count(differing, each.pixel) > 0;
    CHECK(each.differs == differs);
    const bool selected = each.differs || each.surveyed;
    CHECK(selected);
  }
}

TEST_CASE("a survey of more pixels than there are takes all") {
  const std::vector<SelectedPixel> pixels = select_pixels({}, 5, 4, 1000);
  CHECK(pixels.size() == 20);
  CHECK(places(pixels).size() == 20);
}

TEST_CASE("without a survey only pixels that differ are selected") {
  CHECK(select_pixels({}, 5, 4, 0).empty());
  const std::vector<glm::uvec2> one = {{1, 2}};
  CHECK(select_pixels(one, 5, 4, 0).size() == 1);
}

TEST_CASE("each quarter of the survey is spread over the picture") {
  const std::vector<SelectedPixel> pixels = select_pixels({}, 64, 64, 256);
  REQUIRE(pixels.size() == 256);
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    std::size_t left = 0, upper = 0;
    for (std::size_t i = 64 * quarter; i < 64 * (quarter + 1); ++i) {
      left += pixels[i].pixel.x < 32 ? 1 : 0;
      upper += pixels[i].pixel.y < 32 ? 1 : 0;
    }
    // Of 64 fair coins fewer than 16 or more than 48 have a probability of 4e-5; the order is always the same.
    CHECK(left >= 16);
    CHECK(left <= 48);
    CHECK(upper >= 16);
    CHECK(upper <= 48);
  }
}

}  // namespace
}  // namespace tandem::compare
