#pragma once

#include <cstdint>
#include <optional>

#include "pathtracer/image/image.hpp"

/// How far two images of the same scene are apart, in numbers and in a verdict.
namespace tandem::compare {

/// Differences between image a (the reference) and image b, in linear radiance.
///
/// A pixel with a NaN or an infinity in any channel of either image counts as different in the three fractions, even
/// when both images hold the same bits, and takes no part in the sums below them: no number here is ever NaN or
/// infinite.
struct Metrics {
  std::uint64_t pixels = 0;
  double bit_equal = 0.0;   ///< fraction of pixels whose three channels have the same bits; +0 and -0 do not
  double within_1e5 = 0.0;  ///< fraction of pixels with |a - b| <= 1e-5 max(|a|, |b|) in each channel
  double within_1e3 = 0.0;  ///< the same with 1e-3
  double max_abs = 0.0;     ///< largest |a - b| of any channel
  double mean_abs = 0.0;    ///< mean |a - b| over pixels and channels
  double mean_a = 0.0;      ///< mean over pixels and channels
  double mean_b = 0.0;
  /// What |mean_a - mean_b| would come to if the signs of the pixels' differences were chance: the root of the sum of
  /// their squares (of the means over channels), over the number of pixels.
  double mean_noise = 0.0;
  double rmse = 0.0;               ///< root of the mean of (a - b)^2 over pixels and channels
  double peak = 0.0;               ///< largest |value| of any channel of either image
  std::optional<double> psnr;      ///< 20 log10(peak / rmse) in dB; none when rmse is 0
  std::uint64_t non_finite_a = 0;  ///< pixels of a with a NaN or an infinity
  std::uint64_t non_finite_b = 0;
};

/// Throws Error when the images differ in size, are empty, or do not hold width * height pixels.
Metrics measure(const pathtracer::Image& a, const pathtracer::Image& b);

}  // namespace tandem::compare
