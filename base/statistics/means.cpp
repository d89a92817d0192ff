#include "base/statistics/means.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "base/statistics/distributions.hpp"

namespace tandem::statistics {
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

DifferenceError difference_error(const Mean& a, const Mean& b) {
  const double variance_a = a.standard_error * a.standard_error;
  const double variance_b = b.standard_error * b.standard_error;
  const double variance = variance_a + variance_b;
  if (!(variance > 0)) return {};
  const double share_a = variance_a / variance;  // so that no square of a small variance vanishes
  const double share_b = variance_b / variance;
  return {.standard_error = std::sqrt(variance),
          .freedom = 1 / (share_a * share_a / (a.count - 1) + share_b * share_b / (b.count - 1))};
}

double welch_p_value(const Mean& a, const Mean& b) {
  const double difference = std::abs(a.value - b.value);
  const double rounding = 1e-6 * std::max(std::abs(a.value), std::abs(b.value));
  const DifferenceError error = difference_error(a, b);
  if (!std::isfinite(difference) || !std::isfinite(a.standard_error + b.standard_error)) return 0.0;
  if (difference <= rounding) return 1.0;
  if (error.freedom == 0) return 0.0;
  return student_p_value(difference / error.standard_error, error.freedom);
}

}  // namespace tandem::statistics
