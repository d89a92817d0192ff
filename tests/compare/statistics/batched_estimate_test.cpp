#include "compare/statistics/batched_estimate.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "base/error.hpp"

namespace tandem::compare {
namespace {

pathtracer::Image constant(std::uint32_t width, std::uint32_t height, const glm::vec3& color) {
  return {.width = width, .height = height, .pixels = std::vector<glm::vec3>(std::size_t{width} * height, color)};
}

TEST_CASE("tiles cover the picture, the last ones smaller") {
  const BatchedEstimate estimate(20, 9, 8);
  REQUIRE(estimate.tiles().size() == 6);
  std::uint32_t pixels = 0;
  for (const Tile& tile : estimate.tiles()) pixels += tile.width * tile.height;
  CHECK(pixels == 20 * 9);
  CHECK(estimate.tiles()[5].left == 16);
  CHECK(estimate.tiles()[5].top == 8);
  CHECK(estimate.tiles()[5].width == 4);
  CHECK(estimate.tiles()[5].height == 1);
  CHECK(BatchedEstimate(3, 3, std::numeric_limits<std::uint32_t>::max()).tiles().size() == 1);
}

TEST_CASE("means and errors are those of the batches") {
  BatchedEstimate estimate(4, 2, 2);
  pathtracer::Image first = constant(4, 2, {1, 2, 3});
  first.pixels[0] = {5, 2, 3};
  estimate.add(first);
  estimate.add(constant(4, 2, {3, 2, 3}));
  REQUIRE(estimate.batches() == 2);
  // The first tile: 2 and 3 in red; the second: 1 and 3.
  CHECK(estimate.tile_mean(0, Channel::red).value == 2.5);
  CHECK(estimate.tile_mean(0, Channel::red).standard_error == doctest::Approx(0.5));
  CHECK(estimate.tile_mean(1, Channel::red).value == 2.0);
  CHECK(estimate.tile_mean(1, Channel::blue).standard_error == 0.0);
  CHECK(estimate.tile_mean(1, Channel::luminance).value ==
        doctest::Approx(0.2126 * 2 + 0.7152 * 2 + 0.0722 * 3).epsilon(1e-12));
  CHECK(estimate.picture_mean(Channel::red).value == 2.25);
  CHECK(estimate.picture_mean(Channel::red).count == 2);
  CHECK(estimate.image().at(0, 0) == glm::vec3(4, 2, 3));
  CHECK(estimate.image().at(3, 1) == glm::vec3(2, 2, 3));
}

TEST_CASE("pixels that are not finite are left out of means, and stay in the picture") {
  BatchedEstimate estimate(2, 1, 2);
  pathtracer::Image broken = constant(2, 1, {1, 1, 1});
  broken.pixels[0].y = std::numeric_limits<float>::quiet_NaN();
  estimate.add(broken);
  estimate.add(constant(2, 1, {3, 3, 3}));
  CHECK(estimate.tile_mean(0, Channel::green).value == 2.0);
  CHECK(std::isnan(estimate.image().at(0, 0).y));
  broken.pixels[1].x = std::numeric_limits<float>::infinity();
  estimate.add(broken);  // not one finite pixel
  CHECK(std::isfinite(estimate.tile_mean(0, Channel::red).value));
}

TEST_CASE("batches of another size are refused") {
  BatchedEstimate estimate(2, 2, 2);
  CHECK_THROWS_AS(estimate.add(constant(2, 1, {1, 1, 1})), tandem::Error);
}

}  // namespace
}  // namespace tandem::compare
