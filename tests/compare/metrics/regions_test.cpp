#include "compare/metrics/regions.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "tests/compare/image/images.hpp"

namespace tandem::compare {
namespace {

TEST_CASE("regions cover each pixel once, row by row") {
  const pathtracer::Image a = noise_image(13, 7, 1);
  const std::vector<Region> grid = regions(a, a);
  REQUIRE(grid.size() == 16);
  std::vector<int> covered(a.pixels.size());
  for (std::size_t index = 0; index < grid.size(); ++index) {
    const Region& region = grid[index];
    CHECK(region.row == index / 4);
    CHECK(region.column == index % 4);
    CHECK((region.width == 3 || region.width == 4));
    CHECK((region.height == 1 || region.height == 2));
    CHECK(region.metrics.pixels == region.width * region.height);
    CHECK_FALSE(region.flip.has_value());
    for (std::uint32_t y = region.y; y < region.y + region.height; ++y) {
      for (std::uint32_t x = region.x; x < region.x + region.width; ++x) ++covered[y * 13 + x];
    }
  }
  CHECK(covered == std::vector<int>(a.pixels.size(), 1));
  CHECK_FALSE(worst_region(grid).has_value());
}

TEST_CASE("images smaller than the grid have a region for each row or column") {
  const pathtracer::Image a = noise_image(3, 1, 1);
  const std::vector<Region> grid = regions(a, a);
  REQUIRE(grid.size() == 3);
  CHECK(grid[2].x == 2);
  CHECK(grid[2].width == 1);
}

TEST_CASE("a region has the metrics of its pixels and the mean of their visible errors") {
  const pathtracer::Image a = constant_image(8, 8, glm::vec3(1.0F));
  pathtracer::Image b = a;
  b.pixels[5 * 8 + 2] = glm::vec3(3.0F, 1.0F, 1.0F);
  FlipErrors errors{.width = 8, .height = 8, .errors = std::vector<float>(64, 0.25F)};
  errors.errors[5 * 8 + 2] = 0.75F;
  const std::vector<Region> grid = regions(a, b, &errors);
  const Region& region = grid[2 * 4 + 1];
  CHECK(region.metrics.bit_equal == 0.75);
  CHECK(region.metrics.max_abs == 2.0);
  CHECK(region.metrics.rmse == doctest::Approx(std::sqrt(4.0 / 12.0)).epsilon(1e-15));
  REQUIRE(region.flip.has_value());
  CHECK(*region.flip == 0.375);
  CHECK(grid[0].metrics.bit_equal == 1.0);
  CHECK(grid[0].flip == 0.25);
  REQUIRE(worst_region(grid).has_value());
  CHECK(*worst_region(grid) == 9);
  CHECK(std::string(name(region)) == "row 3, column 2 (pixels 2,4 to 3,5)");
}

TEST_CASE("the worst region is the one that is not finite, else that of the largest error, else of the fewest bits") {
  const pathtracer::Image a = constant_image(4, 4, glm::vec3(0.0F));
  pathtracer::Image b = a;
  b.pixels[3] = glm::vec3(-0.0F);
  CHECK(worst_region(regions(a, b)) == 3);
  b.pixels[9] = glm::vec3(1e-6F);
  CHECK(worst_region(regions(a, b)) == 9);
  b.pixels[12] = glm::vec3(1e-3F);
  CHECK(worst_region(regions(a, b)) == 12);
  b.pixels[6].y = std::numeric_limits<float>::infinity();
  CHECK(worst_region(regions(a, b)) == 6);
}

}  // namespace
}  // namespace tandem::compare
