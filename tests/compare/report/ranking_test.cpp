#include "compare/report/ranking.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "tests/compare/image/images.hpp"

namespace tandem::compare {
namespace {

ClassifiedPixel classified(glm::uvec2 pixel, DifferenceClass difference_class) {
  return {.pixel = pixel, .difference_class = difference_class};
}

TEST_CASE("pixels are ranked by their difference, and equal ones are not ranked") {
  const pathtracer::Image a = constant_image(4, 2, glm::vec3(0.5F));
  pathtracer::Image b = a;
  b.pixels[1].y = 0.25F;
  b.pixels[6].x = -1.0F;
  b.pixels[3].z = std::numeric_limits<float>::quiet_NaN();
  const Ranking ranking = rank_pixels(a, b, nullptr, 10);
  CHECK(ranking.differing_pixels == 3);
  REQUIRE(ranking.pixels.size() == 3);
  CHECK(ranking.pixels[0].pixel == glm::uvec2(3, 0));
  CHECK(ranking.pixels[1].pixel == glm::uvec2(2, 1));
  CHECK(ranking.pixels[1].difference == 1.5);
  CHECK(ranking.pixels[2].pixel == glm::uvec2(1, 0));
  CHECK(ranking.pixels[2].difference == 0.25);
  CHECK_FALSE(ranking.pixels[0].difference_class);
}

TEST_CASE("zeros of other signs differ, by nothing") {
  const pathtracer::Image a = constant_image(1, 1, glm::vec3(0.0F));
  const Ranking ranking = rank_pixels(a, constant_image(1, 1, glm::vec3(-0.0F)), nullptr, 10);
  REQUIRE(ranking.differing_pixels == 1);
  CHECK(ranking.pixels[0].difference == 0);
}

TEST_CASE("the worst class comes first, whatever the difference, and what was not classed last") {
  const pathtracer::Image a = constant_image(4, 1, glm::vec3(0.5F));
  pathtracer::Image b = a;
  b.pixels[0].x = 9.0F;
  b.pixels[1].x = 2.0F;
  b.pixels[2].x = 0.5001F;
  Classification classification;
  classification.pixels = {classified({1, 0}, DifferenceClass::flipped_decision),
                           classified({2, 0}, DifferenceClass::mismatch),
                           // Has the same bits, but its path has not.
                           classified({3, 0}, DifferenceClass::mismatch)};
  const Ranking ranking = rank_pixels(a, b, &classification, 10);
  CHECK(ranking.differing_pixels == 3);
  REQUIRE(ranking.pixels.size() == 4);
  CHECK(ranking.pixels[0].pixel == glm::uvec2(2, 0));
  CHECK(ranking.pixels[1].pixel == glm::uvec2(3, 0));
  CHECK(ranking.pixels[2].pixel == glm::uvec2(1, 0));
  CHECK(ranking.pixels[3].pixel == glm::uvec2(0, 0));

  const Ranking two = rank_pixels(a, b, &classification, 2);
  CHECK(two.differing_pixels == 3);
  CHECK(two.pixels.size() == 2);
}

TEST_CASE("recorded are the worst class, then others spread evenly") {
  Ranking ranking;
  for (unsigned i = 0; i < 100; ++i)
    ranking.pixels.push_back(
        {.pixel = {i, 0}, .difference_class = i < 3 ? DifferenceClass::mismatch : DifferenceClass::rounding});
  const std::vector<RankedPixel> ten = pixels_to_record(ranking, 10);
  REQUIRE(ten.size() == 10);
  for (unsigned i = 0; i < 3; ++i) CHECK(ten[i].pixel.x == i);
  for (std::size_t i = 3; i < 10; ++i) CHECK(ten[i].pixel.x == 3 + (i - 3) * 97 / 7);
  // Of a worst class that is large, half.
  ranking.pixels.resize(3);
  CHECK(pixels_to_record(ranking, 10).size() == 3);
  for (unsigned i = 3; i < 100; ++i)
    ranking.pixels.push_back({.pixel = {i, 0}, .difference_class = DifferenceClass::mismatch});
  const std::vector<RankedPixel> of_one = pixels_to_record(ranking, 10);
  REQUIRE(of_one.size() == 10);
  for (unsigned i = 0; i < 5; ++i) CHECK(of_one[i].pixel.x == i);
  CHECK(of_one[9].pixel.x > 50);
}

}  // namespace
}  // namespace tandem::compare
