#pragma once

#include "pathtracer/image/image.hpp"

namespace tandem::compare {

/// Relative differences of the values of two images, three values for each pixel that is finite in both. The difference
/// of two values is |a - b| / max(|a|, |b|): 0 when both are zero, at most 2 (opposite signs). All 0 without values.
struct RelativeError {
  double percentile_50 =
      0.0;  ///< half of the values differ by no more than this: the smallest value with that property
  double percentile_90 = 0.0;
  double percentile_99 = 0.0;
  double percentile_99_9 = 0.0;
  double largest = 0.0;

  /// Mean of (a - b)^2 / (a^2 + 0.01), a being the reference (Rousselle, Knaus and Zwicker, Adaptive Sampling and
  /// Reconstruction using Greedy Error Minimization, 2011): errors weigh as the eye sees them, dark or bright. The
  /// constant keeps black pixels from counting without bound; it is the usual one.
  double rel_mse = 0.0;
};

/// Throws as check_pair.
RelativeError relative_error(const pathtracer::Image& a, const pathtracer::Image& b);

}  // namespace tandem::compare
