#include "compare/metrics/ssim.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/srgb.hpp"
#include "tests/compare/image/images.hpp"

namespace tandem::compare {
namespace {

/// An image whose encoded luma is the given values.
pathtracer::Image gray(std::uint32_t width, std::uint32_t height, const std::vector<double>& luma) {
  std::vector<glm::vec3> pixels;
  for (const double value : luma) pixels.emplace_back(tandem::srgb_decode(static_cast<float>(value)));
  return image(width, height, pixels);
}

/// Equation 13 of the paper, written out for each window: 121 weights, sums over their pixels, no separation.
double ssim_of_paper(std::uint32_t width, std::uint32_t height, const std::vector<double>& x,
                     const std::vector<double>& y) {
  double total = 0.0;
  for (std::uint32_t top = 0; top + 11 <= height; ++top) {
    for (std::uint32_t left = 0; left + 11 <= width; ++left) {
      double weights = 0.0;
      double sum_x = 0.0;
      double sum_y = 0.0;
      const auto over_window = [&](const auto& add) {
        for (int row = 0; row < 11; ++row) {
          for (int column = 0; column < 11; ++column) {
            const double squared = (row - 5) * (row - 5) + (column - 5) * (column - 5);
            add(std::exp(-squared / (2 * 1.5 * 1.5)), (top + row) * width + left + column);
          }
        }
      };
      over_window([&](double weight, std::size_t at) {
        weights += weight;
        sum_x += weight * x[at];
        sum_y += weight * y[at];
      });
      const double mean_x = sum_x / weights;
      const double mean_y = sum_y / weights;
      double variance_x = 0.0;
      double variance_y = 0.0;
      double covariance = 0.0;
      over_window([&](double weight, std::size_t at) {
        variance_x += weight / weights * (x[at] - mean_x) * (x[at] - mean_x);
        variance_y += weight / weights * (y[at] - mean_y) * (y[at] - mean_y);
        covariance += weight / weights * (x[at] - mean_x) * (y[at] - mean_y);
      });
      total += (2 * mean_x * mean_y + 0.0001) * (2 * covariance + 0.0009) /
               ((mean_x * mean_x + mean_y * mean_y + 0.0001) * (variance_x + variance_y + 0.0009));
    }
  }
  return total / ((width - 10.0) * (height - 10.0));
}

TEST_CASE("structural similarity is 1 for equal pictures and symmetric") {
  const pathtracer::Image a = noise_image(32, 24, 1);
  const pathtracer::Image b = noise_image(32, 24, 2);
  CHECK(ssim(a, a) == 1.0);
  CHECK(ssim(a, b) == ssim(b, a));
  CHECK(ssim(a, b) < 0.1);
}

TEST_CASE("structural similarity of constant pictures is that of their means") {
  const auto expected = [](double x, double y) { return (2 * x * y + 0.0001) / (x * x + y * y + 0.0001); };
  for (const std::uint32_t size : {1U, 5U, 10U, 11U, 40U}) {
    CAPTURE(size);
    const std::vector<double> quarter(std::size_t{size} * size, 0.25);
    const std::vector<double> half(std::size_t{size} * size, 0.5);
    // The sRGB curve and its inverse in float.
    CHECK(ssim(gray(size, size, quarter), gray(size, size, half)) ==
          doctest::Approx(expected(0.25, 0.5)).epsilon(1e-6));
  }
  CHECK(ssim(constant_image(16, 16, glm::vec3(0.0F)), constant_image(16, 16, glm::vec3(1.0F))) ==
        doctest::Approx(expected(0.0, 1.0)).epsilon(1e-6));
}

TEST_CASE("structural similarity is the paper's formula over windows within the picture") {
  constexpr std::uint32_t width = 27;
  constexpr std::uint32_t height = 19;
  std::vector<double> x;
  std::vector<double> y;
  for (const glm::vec3& pixel : noise_image(width, height, 3).pixels) {
    x.push_back(pixel.x);
    y.push_back(0.7 * pixel.x + 0.3 * pixel.y);
  }
  const double expected = ssim_of_paper(width, height, x, y);
  CHECK(expected > 0.5);
  CHECK(expected < 0.95);
  // The sRGB curve and its inverse in float.
  CHECK(ssim(gray(width, height, x), gray(width, height, y)) == doctest::Approx(expected).epsilon(1e-5));
}

TEST_CASE("inverted structure has a negative similarity") {
  std::vector<double> x;
  std::vector<double> y;
  for (const glm::vec3& pixel : noise_image(30, 30, 4).pixels) {
    x.push_back(pixel.x);
    y.push_back(1.0 - pixel.x);
  }
  CHECK(ssim(gray(30, 30, x), gray(30, 30, y)) < -0.8);
}

TEST_CASE("structural similarity is that of what a picture shows") {
  const pathtracer::Image a = noise_image(20, 20, 5);
  pathtracer::Image b = a;
  b.pixels[7] = glm::vec3(1.0F);
  pathtracer::Image brighter = b;
  brighter.pixels[7] = glm::vec3(7.0F, 1e30F, std::numeric_limits<float>::infinity());
  CHECK(ssim(a, brighter) == ssim(a, b));
  b.pixels[7] = glm::vec3(0.0F);
  brighter.pixels[7] = glm::vec3(-3.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F);
  CHECK(ssim(a, brighter) == ssim(a, b));
}

}  // namespace
}  // namespace tandem::compare
