#include "compare/metrics/relative_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "compare/image/image_pair.hpp"

namespace tandem::compare {
namespace {

constexpr double rel_mse_epsilon = 0.01;

/// The value of nearest rank. `values` must not be empty; their order changes.
double percentile(std::vector<double>& values, double fraction) {
  const double rank = std::ceil(fraction * static_cast<double>(values.size()));
  const auto index = static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

}  // namespace

RelativeError relative_error(const pathtracer::Image& a, const pathtracer::Image& b) {
  check_pair(a, b);
  std::vector<double> differences;
  differences.reserve(a.pixels.size() * 3);
  double sum = 0.0;
  for (std::size_t index = 0; index < a.pixels.size(); ++index) {
    const glm::vec3& pixel_a = a.pixels[index];
    const glm::vec3& pixel_b = b.pixels[index];
    if (!is_finite(pixel_a) || !is_finite(pixel_b)) continue;
    for (int channel = 0; channel < 3; ++channel) {
      const double value_a = pixel_a[channel];
      const double value_b = pixel_b[channel];
      const double difference = std::abs(value_a - value_b);
      differences.push_back(difference == 0.0 ? 0.0 : difference / std::max(std::abs(value_a), std::abs(value_b)));
      sum += difference * difference / (value_a * value_a + rel_mse_epsilon);
    }
  }
  RelativeError error;
  if (differences.empty()) return error;
  error.rel_mse = sum / static_cast<double>(differences.size());
  error.percentile_50 = percentile(differences, 0.5);
  error.percentile_90 = percentile(differences, 0.9);
  error.percentile_99 = percentile(differences, 0.99);
  error.percentile_99_9 = percentile(differences, 0.999);
  error.largest = *std::max_element(differences.begin(), differences.end());
  return error;
}

}  // namespace tandem::compare
