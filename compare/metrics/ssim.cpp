#include "compare/metrics/ssim.hpp"

#include "compare/image/image_pair.hpp"
#include "compare/image/plane.hpp"
#include "pathtracer/image/tone_map.hpp"
#include "pathtracer/scene/lights.hpp"

namespace tandem::compare {
namespace {

constexpr int radius = 5;
constexpr double sigma = 1.5;
constexpr double c1 = 0.01 * 0.01;
constexpr double c2 = 0.03 * 0.03;

Plane luma(const pathtracer::Image& image) {
  Plane plane{.width = image.width, .height = image.height, .values = {}};
  plane.values.reserve(image.pixels.size());
  for (const glm::vec3& pixel : image.pixels) {
    plane.values.push_back(pathtracer::luminance(pathtracer::tone_mapped(pixel, {})));
  }
  return plane;
}

Plane product(const Plane& a, const Plane& b) {
  Plane result = a;
  for (std::size_t index = 0; index < a.values.size(); ++index) result.values[index] *= b.values[index];
  return result;
}

}  // namespace

double ssim(const pathtracer::Image& a, const pathtracer::Image& b) {
  check_pair(a, b);
  const std::vector<double> window = gaussian_kernel(sigma, radius);
  const auto mean = [&](const Plane& plane) { return filtered(plane, window, window); };
  const Plane luma_a = luma(a);
  const Plane luma_b = luma(b);
  const Plane mean_a = mean(luma_a);
  const Plane mean_b = mean(luma_b);
  const Plane mean_aa = mean(product(luma_a, luma_a));
  const Plane mean_bb = mean(product(luma_b, luma_b));
  const Plane mean_ab = mean(product(luma_a, luma_b));

  const std::size_t width = a.width;
  const std::size_t height = a.height;
  const std::size_t border = width > 2 * radius && height > 2 * radius ? radius : 0;
  double sum = 0.0;
  for (std::size_t y = border; y < height - border; ++y) {
    for (std::size_t x = border; x < width - border; ++x) {
      const std::size_t index = y * width + x;
      const double a_mean = mean_a.values[index];
      const double b_mean = mean_b.values[index];
      const double a_variance = mean_aa.values[index] - a_mean * a_mean;
      const double b_variance = mean_bb.values[index] - b_mean * b_mean;
      const double covariance = mean_ab.values[index] - a_mean * b_mean;
      sum += (2.0 * a_mean * b_mean + c1) * (2.0 * covariance + c2) /
             ((a_mean * a_mean + b_mean * b_mean + c1) * (a_variance + b_variance + c2));
    }
  }
  return sum / static_cast<double>((width - 2 * border) * (height - 2 * border));
}

}  // namespace tandem::compare
