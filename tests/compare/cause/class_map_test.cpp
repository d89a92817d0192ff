#include "compare/cause/class_map.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include "base/srgb.hpp"

namespace tandem::compare {
namespace {

glm::vec3 linear(float red, float green, float blue) {
  return {srgb_decode(red / 255), srgb_decode(green / 255), srgb_decode(blue / 255)};
}

const glm::vec3 black(0);
const glm::vec3 grey = linear(0x60, 0x60, 0x60);

TEST_CASE("a map of classes is black where the bits are the same, and grey where nothing is known") {
  pathtracer::Image a{.width = 3, .height = 2, .pixels = std::vector<glm::vec3>(6, glm::vec3(0.5f))};
  pathtracer::Image b = a;
  b.pixels[1].z = 0.75f;
  a.pixels[3].x = 0.0f, b.pixels[3].x = -0.0f;  // other bits of the same value
  a.pixels[5].y = b.pixels[5].y = std::numeric_limits<float>::quiet_NaN();
  const pathtracer::Image map = class_map({}, a, b);
  CHECK(map.width == 3);
  CHECK(map.height == 2);
  CHECK(map.pixels == std::vector<glm::vec3>{black, grey, black, grey, black, black});
}

TEST_CASE("a map of classes has each classed pixel in its class's colour, wherever it was looked at") {
  const pathtracer::Image a{.width = 3, .height = 2, .pixels = std::vector<glm::vec3>(6, glm::vec3(0.5f))};
  pathtracer::Image b = a;
  b.pixels[1].x = b.pixels[3].x = b.pixels[4].x = 0.75f;
  Classification classification;
  classification.pixels = {{.pixel = {1, 0}, .difference_class = DifferenceClass::rounding},
                           {.pixel = {0, 1}, .difference_class = DifferenceClass::flipped_decision},
                           {.pixel = {2, 1}, .difference_class = DifferenceClass::mismatch}};  // surveyed
  const pathtracer::Image map = class_map(classification, a, b);
  CHECK(map.pixels == std::vector<glm::vec3>{black, linear(0x44, 0x77, 0xaa), black, linear(0xcc, 0xbb, 0x44), grey,
                                             linear(0xff, 0x20, 0x20)});
}

}  // namespace
}  // namespace tandem::compare
