#include "compare/image/ulp_histogram.hpp"

#include <algorithm>
#include <bit>

#include "compare/image/image_pair.hpp"
#include "compare/image/ulp.hpp"

namespace tandem::compare {
namespace {

/// 0, 1, 2, 3-4, 5-8, ...: the whole binary logarithm rounded up, and one more.
std::size_t bin_of(std::uint64_t distance) {
  return distance == 0 ? 0 : static_cast<std::size_t>(std::bit_width(distance - 1)) + 1;
}

UlpBin empty_bin(std::size_t index) {
  if (index < 2) return {.least = index, .most = index, .values = 0};
  return {.least = (std::uint64_t{1} << (index - 2)) + 1, .most = std::uint64_t{1} << (index - 1), .values = 0};
}

}  // namespace

UlpHistogram ulp_histogram(const pathtracer::Image& a, const pathtracer::Image& b) {
  check_pair(a, b);
  UlpHistogram histogram;
  for (std::size_t index = 0; index < a.pixels.size(); ++index) {
    const glm::vec3& pixel_a = a.pixels[index];
    const glm::vec3& pixel_b = b.pixels[index];
    if (!is_finite(pixel_a) || !is_finite(pixel_b)) continue;
    for (int channel = 0; channel < 3; ++channel) {
      const std::uint64_t distance = ulp_distance(pixel_a[channel], pixel_b[channel]);
      const std::size_t bin = bin_of(distance);
      while (histogram.bins.size() <= bin) histogram.bins.push_back(empty_bin(histogram.bins.size()));
      ++histogram.bins[bin].values;
      ++histogram.values;
      histogram.largest = std::max(histogram.largest, distance);
    }
  }
  return histogram;
}

}  // namespace tandem::compare
