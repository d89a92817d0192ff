#include "tests/statistics/means.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "tests/statistics/distributions.hpp"

namespace tandem::test {
namespace {

/// Sum over the pixels of a tile of one channel, over the number of pixels.
double tile_mean(const pathtracer::Image& image, std::uint32_t left, std::uint32_t top, std::uint32_t tile,
                 int channel) {
  double sum = 0;
  double count = 0;
  for (std::uint32_t y = top; y < std::min(top + tile, image.height); ++y)
    for (std::uint32_t x = left; x < std::min(left + tile, image.width); ++x) {
      sum += image.at(x, y)[channel];
      count += 1;
    }
  return sum / count;
}

Mean tile_mean(std::span<const pathtracer::Image> images, std::uint32_t left, std::uint32_t top, std::uint32_t tile,
               int channel) {
  std::vector<double> means;
  for (const pathtracer::Image& image : images) means.push_back(tile_mean(image, left, top, tile, channel));
  return mean_of(means);
}

}  // namespace

Mean mean_of(std::span<const double> samples) {
  if (samples.size() < 2) throw std::invalid_argument("a mean with its error needs two samples");
  const double count = static_cast<double>(samples.size());
  const double mean = std::reduce(samples.begin(), samples.end()) / count;
  double squares = 0;
  for (const double sample : samples) squares += (sample - mean) * (sample - mean);
  return {.value = mean, .standard_error = std::sqrt(squares / (count - 1) / count), .count = count};
}

double z_score(const Mean& mean, double truth) {
  return mean.value == truth ? 0.0 : (mean.value - truth) / mean.standard_error;
}

double welch_p_value(const Mean& a, const Mean& b) {
  const double variance_a = a.standard_error * a.standard_error;
  const double variance_b = b.standard_error * b.standard_error;
  const double variance = variance_a + variance_b;
  const double difference = std::abs(a.value - b.value);
  const double rounding = 1e-6 * std::max(std::abs(a.value), std::abs(b.value));
  if (!std::isfinite(difference) || !std::isfinite(variance)) return 0.0;
  if (difference <= rounding) return 1.0;
  if (variance == 0) return 0.0;
  // Welch and Satterthwaite's approximation of the degrees of freedom.
  const double freedom =
      variance * variance / (variance_a * variance_a / (a.count - 1) + variance_b * variance_b / (b.count - 1));
  return student_p_value(difference / std::sqrt(variance), freedom);
}

double tiles_p_value(std::span<const pathtracer::Image> a, std::span<const pathtracer::Image> b, std::uint32_t tile) {
  double smallest = 1;
  std::size_t tests = 0;
  for (std::uint32_t top = 0; top < a.front().height; top += tile)
    for (std::uint32_t left = 0; left < a.front().width; left += tile)
      for (int channel = 0; channel < 3; ++channel, ++tests)
        smallest = std::min(
            smallest, welch_p_value(tile_mean(a, left, top, tile, channel), tile_mean(b, left, top, tile, channel)));
  return sidak(smallest, tests);
}

}  // namespace tandem::test
