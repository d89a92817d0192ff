#include "compare/metrics/metrics.hpp"

#include <algorithm>
#include <cmath>

#include "compare/image/image_pair.hpp"

namespace tandem::compare {
namespace {

constexpr int channels = 3;

bool is_within(const glm::vec3& a, const glm::vec3& b, double tolerance) {
  for (int channel = 0; channel < channels; ++channel) {
    const double value_a = a[channel];
    const double value_b = b[channel];
    if (std::abs(value_a - value_b) > tolerance * std::max(std::abs(value_a), std::abs(value_b))) return false;
  }
  return true;
}

}  // namespace

Metrics measure(const pathtracer::Image& a, const pathtracer::Image& b) {
  check_pair(a, b);
  std::uint64_t bit_equal = 0;
  std::uint64_t within_1e5 = 0;
  std::uint64_t within_1e3 = 0;
  std::uint64_t finite = 0;
  double sum_a = 0.0;
  double sum_b = 0.0;
  double sum_abs = 0.0;
  double sum_squares = 0.0;
  double sum_pixel_squares = 0.0;
  Metrics metrics;
  metrics.pixels = a.pixels.size();
  for (std::size_t index = 0; index < a.pixels.size(); ++index) {
    const glm::vec3& pixel_a = a.pixels[index];
    const glm::vec3& pixel_b = b.pixels[index];
    const bool finite_a = is_finite(pixel_a);
    const bool finite_b = is_finite(pixel_b);
    metrics.non_finite_a += finite_a ? 0 : 1;
    metrics.non_finite_b += finite_b ? 0 : 1;
    if (!finite_a || !finite_b) continue;
    ++finite;
    bit_equal += is_bit_equal(pixel_a, pixel_b) ? 1 : 0;
    within_1e5 += is_within(pixel_a, pixel_b, 1e-5) ? 1 : 0;
    within_1e3 += is_within(pixel_a, pixel_b, 1e-3) ? 1 : 0;
    double pixel_difference = 0.0;
    for (int channel = 0; channel < channels; ++channel) {
      const double value_a = pixel_a[channel];
      const double value_b = pixel_b[channel];
      const double difference = std::abs(value_a - value_b);
      pixel_difference += (value_a - value_b) / channels;
      sum_a += value_a;
      sum_b += value_b;
      sum_abs += difference;
      sum_squares += difference * difference;
      metrics.max_abs = std::max(metrics.max_abs, difference);
      metrics.peak = std::max({metrics.peak, std::abs(value_a), std::abs(value_b)});
    }
    sum_pixel_squares += pixel_difference * pixel_difference;
  }

  const auto pixels = static_cast<double>(metrics.pixels);
  metrics.bit_equal = static_cast<double>(bit_equal) / pixels;
  metrics.within_1e5 = static_cast<double>(within_1e5) / pixels;
  metrics.within_1e3 = static_cast<double>(within_1e3) / pixels;
  if (finite == 0) return metrics;
  const double values = static_cast<double>(finite) * channels;
  metrics.mean_a = sum_a / values;
  metrics.mean_b = sum_b / values;
  metrics.mean_abs = sum_abs / values;
  metrics.mean_noise = std::sqrt(sum_pixel_squares) / static_cast<double>(finite);
  metrics.rmse = std::sqrt(sum_squares / values);
  // Zero, or so small that its square vanished: then the ratio to the peak means nothing.
  if (metrics.rmse > 0.0) metrics.psnr = 20.0 * std::log10(metrics.peak / metrics.rmse);
  return metrics;
}

}  // namespace tandem::compare
