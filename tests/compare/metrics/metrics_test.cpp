#include "compare/metrics/metrics.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace tandem::compare {
namespace {

// Sums of a handful of doubles that float holds exactly: only the last rounding of a quotient or a root may differ.
constexpr double rounding = 1e-15;

pathtracer::Image image(std::uint32_t width, std::uint32_t height, std::vector<glm::vec3> pixels) {
  return {.width = width, .height = height, .pixels = std::move(pixels)};
}

TEST_CASE("equal images have no difference and no signal-to-noise ratio") {
  const pathtracer::Image a = image(2, 1, {glm::vec3(1, 2, 3), glm::vec3(0, 0, 6)});
  const Metrics metrics = measure(a, a);
  CHECK(metrics.pixels == 2);
  CHECK(metrics.bit_equal == 1.0);
  CHECK(metrics.within_1e5 == 1.0);
  CHECK(metrics.within_1e3 == 1.0);
  CHECK(metrics.max_abs == 0.0);
  CHECK(metrics.mean_abs == 0.0);
  CHECK(metrics.rmse == 0.0);
  CHECK_FALSE(metrics.psnr.has_value());
  CHECK(metrics.mean_a == doctest::Approx(2.0).epsilon(rounding));
  CHECK(metrics.mean_b == metrics.mean_a);
  CHECK(metrics.peak == 6.0);
}

TEST_CASE("means, extremes and the root mean square are those worked out by hand") {
  // Differences: 1, 0, 0 | 0, -2, 0: six values.
  const pathtracer::Image a = image(1, 2, {glm::vec3(1, 1, 1), glm::vec3(4, 2, 0)});
  const pathtracer::Image b = image(1, 2, {glm::vec3(0, 1, 1), glm::vec3(4, 4, 0)});
  const Metrics metrics = measure(a, b);
  CHECK(metrics.mean_a == doctest::Approx(9.0 / 6.0).epsilon(rounding));
  CHECK(metrics.mean_b == doctest::Approx(10.0 / 6.0).epsilon(rounding));
  CHECK(metrics.mean_abs == doctest::Approx(3.0 / 6.0).epsilon(rounding));
  CHECK(metrics.max_abs == 2.0);
  CHECK(metrics.rmse == doctest::Approx(std::sqrt(5.0 / 6.0)).epsilon(rounding));
  CHECK(metrics.peak == 4.0);
  REQUIRE(metrics.psnr.has_value());
  CHECK(*metrics.psnr == doctest::Approx(10.0 * std::log10(16.0 / (5.0 / 6.0))).epsilon(rounding));
}

TEST_CASE("one channel that differs makes its pixel differ") {
  const pathtracer::Image a = image(4, 1, std::vector<glm::vec3>(4, glm::vec3(1.0F)));
  pathtracer::Image b = a;
  b.pixels[0].x = std::nextafter(1.0F, 2.0F);  // 1.2e-7: not bit-equal, within both
  b.pixels[1].y = 1.0F + 5e-4F;                // within 1e-3 only
  b.pixels[2].z = 1.0F + 5e-3F;                // within neither
  const Metrics metrics = measure(a, b);
  CHECK(metrics.bit_equal == 0.25);
  CHECK(metrics.within_1e5 == 0.5);
  CHECK(metrics.within_1e3 == 0.75);
}

TEST_CASE("relative tolerances follow the larger value, whatever its size and sign") {
  const pathtracer::Image a = image(4, 1, {glm::vec3(1e-30F), glm::vec3(-1e30F), glm::vec3(0.0F), glm::vec3(1e-30F)});
  const pathtracer::Image b =
      image(4, 1, {glm::vec3(1.0005e-30F), glm::vec3(-1.0005e30F), glm::vec3(1e-30F), glm::vec3(-1e-30F)});
  CHECK(measure(a, b).within_1e3 == 0.5);
  CHECK(measure(b, a).within_1e3 == 0.5);
}

TEST_CASE("zeros of different sign are not bit-equal but within every tolerance") {
  const Metrics metrics = measure(image(1, 1, {glm::vec3(0.0F)}), image(1, 1, {glm::vec3(0.0F, -0.0F, 0.0F)}));
  CHECK(metrics.bit_equal == 0.0);
  CHECK(metrics.within_1e5 == 1.0);
  CHECK(metrics.max_abs == 0.0);
}

TEST_CASE("pixels that are not finite count as different and spoil no mean") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const pathtracer::Image a = image(4, 1, {glm::vec3(nan), glm::vec3(0, infinity, 0), glm::vec3(2), glm::vec3(4)});
  const pathtracer::Image b = image(4, 1, {glm::vec3(nan), glm::vec3(7), glm::vec3(2), glm::vec3(4)});
  const Metrics metrics = measure(a, b);
  CHECK(metrics.non_finite_a == 2);
  CHECK(metrics.non_finite_b == 1);
  CHECK(metrics.bit_equal == 0.5);
  CHECK(metrics.within_1e3 == 0.5);
  CHECK(metrics.mean_a == 3.0);
  CHECK(metrics.mean_b == 3.0);
  CHECK(metrics.max_abs == 0.0);
  CHECK(metrics.peak == 4.0);

  const Metrics nothing = measure(image(1, 1, {glm::vec3(nan)}), image(1, 1, {glm::vec3(nan)}));
  CHECK(nothing.bit_equal == 0.0);
  CHECK(nothing.mean_a == 0.0);
  CHECK(nothing.rmse == 0.0);
}

TEST_CASE("the largest finite values do not overflow") {
  const float largest = std::numeric_limits<float>::max();
  const Metrics metrics = measure(image(1, 1, {glm::vec3(largest)}), image(1, 1, {glm::vec3(-largest)}));
  CHECK(metrics.max_abs == 2.0 * static_cast<double>(largest));
  CHECK(std::isfinite(metrics.rmse));
}

TEST_CASE("images that cannot be compared are an error") {
  const pathtracer::Image two = image(2, 1, std::vector<glm::vec3>(2));
  CHECK_THROWS_WITH_AS(measure(two, image(1, 2, std::vector<glm::vec3>(2))),
                       "images of 2x1 and 1x2 pixels cannot be compared", tandem::Error);
  CHECK_THROWS_AS(measure(image(0, 0, {}), image(0, 0, {})), tandem::Error);
  CHECK_THROWS_AS(measure(two, image(2, 1, std::vector<glm::vec3>(1))), tandem::Error);
}

}  // namespace
}  // namespace tandem::compare
