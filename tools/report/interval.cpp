#include "tools/report/interval.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tandem::tools {
namespace {

/// The value below which the share `fraction` of the sorted values lies, between two of them where it falls there.
double quantile(const std::vector<double>& sorted, double fraction) {
  const double place = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

}  // namespace

MedianInterval median_interval(std::vector<double> values, double confidence) {
  std::ranges::sort(values);
  const std::size_t count = values.size();
  MedianInterval interval{.median = quantile(values, 0.5), .least = values.front(), .most = values.back()};
  double below = std::pow(0.5, static_cast<double>(count));  // P(B < k), here for k = 1
  interval.confidence = 1 - 2 * below;
  double binomial = below;  // P(B = k - 1)
  for (std::size_t k = 2; 2 * k <= count; ++k) {
    binomial *= static_cast<double>(count - k + 2) / static_cast<double>(k - 1);
    below += binomial;
    if (1 - 2 * below < confidence) break;
    interval.least = values[k - 1];
    interval.most = values[count - k];
    interval.confidence = 1 - 2 * below;
  }
  return interval;
}

MedianInterval ratio_interval(std::span<const double> reference, std::span<const double> values, double confidence) {
  std::vector<double> ratios(values.size());
  std::ranges::transform(reference, values, ratios.begin(), std::divides<>());
  return median_interval(std::move(ratios), confidence);
}

double relative_noise(std::vector<double> values) {
  std::ranges::sort(values);
  const double median = quantile(values, 0.5);
  return median > 0 ? (quantile(values, 0.75) - quantile(values, 0.25)) / median : 0;
}

}  // namespace tandem::tools
