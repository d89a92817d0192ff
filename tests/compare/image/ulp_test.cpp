#include "compare/image/ulp.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "compare/image/ulp_histogram.hpp"
#include "tests/compare/image/images.hpp"

namespace tandem::compare {
namespace {

constexpr float largest = std::numeric_limits<float>::max();
constexpr float smallest = std::numeric_limits<float>::denorm_min();

TEST_CASE("neighbouring floats are one unit in the last place apart, whatever their size and sign") {
  for (const float value : {0.0F, -0.0F, smallest, 1e-40F, 0.1F, 1.0F, -1.0F, 3e38F, -3e38F, -smallest}) {
    CAPTURE(value);
    CHECK(ulp_distance(value, std::nextafter(value, largest)) == 1);
    CHECK(ulp_distance(std::nextafter(value, -largest), value) == 1);
    CHECK(ulp_distance(value, value) == 0);
  }
}

TEST_CASE("distances in units in the last place go through zero, which is one place") {
  CHECK(ulp_distance(0.0F, -0.0F) == 0);
  CHECK(ulp_distance(-smallest, smallest) == 2);
  CHECK(ulp_distance(1.0F, 2.0F) == 1U << 23U);
  CHECK(ulp_distance(-1.0F, 1.0F) == 2 * std::uint64_t{0x3F800000});
  CHECK(ulp_distance(largest, std::numeric_limits<float>::infinity()) == 1);
  CHECK(ulp_distance(-largest, largest) == 2 * std::uint64_t{0x7F7FFFFF});
}

TEST_CASE("the histogram has a bin for 0, 1 and 2 and then one for each power of two") {
  const auto above_one = [](int steps) { return 1.0F + static_cast<float>(steps) * 0x1p-23F; };
  const pathtracer::Image a = constant_image(4, 1, glm::vec3(1.0F));
  const pathtracer::Image b = image(4, 1,
                                    {{above_one(0), above_one(1), above_one(2)},
                                     {above_one(3), above_one(4), above_one(5)},
                                     {above_one(8), above_one(9), above_one(16)},
                                     {above_one(17), above_one(0), above_one(3)}});
  for (const UlpHistogram& histogram : {ulp_histogram(a, b), ulp_histogram(b, a)}) {
    REQUIRE(histogram.bins.size() == 7);
    const std::uint64_t expected[][3] = {{0, 0, 2}, {1, 1, 1},  {2, 2, 1},  {3, 4, 3},
                                         {5, 8, 2}, {9, 16, 2}, {17, 32, 1}};
    for (std::size_t bin = 0; bin < 7; ++bin) {
      CAPTURE(bin);
      CHECK(histogram.bins[bin].least == expected[bin][0]);
      CHECK(histogram.bins[bin].most == expected[bin][1]);
      CHECK(histogram.bins[bin].values == expected[bin][2]);
    }
    CHECK(histogram.values == 12);
    CHECK(histogram.largest == 17);
  }
}

TEST_CASE("the histogram leaves out pixels that are not finite and takes the largest distances") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const pathtracer::Image a = image(2, 1, {glm::vec3(1, nan, 1), glm::vec3(largest)});
  const pathtracer::Image b = image(2, 1, {glm::vec3(1, nan, 2), glm::vec3(-largest)});
  const UlpHistogram histogram = ulp_histogram(a, b);
  CHECK(histogram.values == 3);
  CHECK(histogram.largest == 2 * std::uint64_t{0x7F7FFFFF});
  REQUIRE(!histogram.bins.empty());
  CHECK(histogram.bins.back().values == 3);
  CHECK(histogram.bins.back().most == std::uint64_t{1} << 32U);
  CHECK(ulp_histogram(constant_image(1, 1, glm::vec3(nan)), constant_image(1, 1, glm::vec3(0.0F))).bins.empty());
}

}  // namespace
}  // namespace tandem::compare
