#include "compare/image/difference.hpp"

#include <doctest/doctest.h>

#include <glm/geometric.hpp>
#include <limits>

#include "base/error.hpp"

namespace tandem::compare {
namespace {

pathtracer::Image row(std::vector<glm::vec3> pixels) {
  const auto width = static_cast<std::uint32_t>(pixels.size());
  return {.width = width, .height = 1, .pixels = std::move(pixels)};
}

float luminance(const glm::vec3& color) { return 0.2126F * color.x + 0.7152F * color.y + 0.0722F * color.z; }

TEST_CASE("the signed difference is a minus b") {
  const pathtracer::Image difference = signed_difference(row({glm::vec3(1, 2, 3)}), row({glm::vec3(3, 2, 1)}));
  CHECK(difference.width == 1);
  CHECK(difference.height == 1);
  CHECK(difference.pixels.at(0) == glm::vec3(-2, 0, 2));
}

TEST_CASE("the heat map shows the scale that it documents") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const pathtracer::Image zero = row(std::vector<glm::vec3>(6, glm::vec3(0.0F)));
  const pathtracer::Image b =
      row({glm::vec3(0.0F), glm::vec3(0, 1e-12F, 0), glm::vec3(-1e-6F, 0, 0), glm::vec3(0, 0, -1.0F),
           glm::vec3(std::numeric_limits<float>::max()), glm::vec3(0, nan, 0)});
  const pathtracer::Image heat = heat_map(zero, b);
  CHECK(heat.pixels[0] == glm::vec3(0.0F));
  CHECK(heat.pixels[1].z > 0.0F);  // any difference can be seen
  CHECK(heat.pixels[1] == heat.pixels[2]);
  CHECK(heat.pixels[3] == glm::vec3(1.0F));
  CHECK(heat.pixels[4] == glm::vec3(1.0F));
  CHECK(heat.pixels[5] == glm::vec3(1.0F, 0.0F, 1.0F));
}

TEST_CASE("each decade of the heat map has a colour of its own and stays in range") {
  glm::vec3 last(0.0F);
  for (float difference = 1e-6F; difference < 2.0F; difference *= 10.0F) {
    const glm::vec3 color = heat_map(row({glm::vec3(difference)}), row({glm::vec3(0.0F)})).pixels[0];
    CHECK(glm::length(color - last) > 0.1F);
    for (int channel = 0; channel < 3; ++channel) CHECK((color[channel] >= 0.0F && color[channel] <= 1.0F));
    last = color;
  }
  CHECK(luminance(last) == doctest::Approx(1.0F));
}

TEST_CASE("images of different sizes have no difference image") {
  const pathtracer::Image one = row({glm::vec3(0.0F)});
  const pathtracer::Image two = row({glm::vec3(0.0F), glm::vec3(0.0F)});
  CHECK_THROWS_AS(signed_difference(one, two), tandem::Error);
  CHECK_THROWS_AS(heat_map(one, two), tandem::Error);
}

}  // namespace
}  // namespace tandem::compare
