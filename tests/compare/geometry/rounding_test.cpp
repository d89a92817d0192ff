#include <doctest/doctest.h>

#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "compare/geometry/rounding.hpp"

namespace tandem::compare {
namespace {

TEST_CASE("devices may be off by what the shader's offset of rays allows them") {
  std::ifstream file(TANDEM_SOURCE_DIRECTORY "/shaders/geometry/offset_ray.glsl");
  REQUIRE(file.is_open());
  std::stringstream shader;
  shader << file.rdbuf();
  const std::string text = shader.str();
  std::smatch found;
  REQUIRE(std::regex_search(text, found, std::regex("const uint OFFSET_ULP = ([0-9]+);")));
  CHECK(std::stod(found[1]) == tolerated_ulp);
}

TEST_CASE("rounding is relative to the largest coordinate") {
  CHECK(largest_magnitude({1, -3, 2}) == 3);
  CHECK(rounding_distance(0) == 0);
  CHECK(rounding_distance(1) == 32 * 0x1p-23);
  CHECK(rounding_distance(1024) == 1024 * rounding_distance(1));
}

}  // namespace
}  // namespace tandem::compare
