#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pathtracer/image.hpp"

/// Whether two ways to estimate something give the same.
namespace tandem::test {

struct Mean {
  double value = 0;
  double standard_error = 0;  ///< of the value, from the spread of the samples
  double count = 0;           ///< of samples
};

/// Of independent samples; at least two.
Mean mean_of(std::span<const double> samples);

/// Deviation of a mean from a known value, in standard errors; 0 / 0 is 0.
double z_score(const Mean& mean, double truth);

/// Two-sided p-value of Welch's test (1947) that two means estimate the same value. Means without any spread are equal
/// when they are within 1e-6 of each other, relatively.
double welch_p_value(const Mean& a, const Mean& b);

/// Two sets of images of the same scene, each image under another seed and so an independent estimate. Tile by tile and
/// channel by channel Welch's test; the result is the Sidak-corrected smallest p-value, small when some tile differs.
/// Images may be as noisy as they like: the noise is measured. Samples within an image need not be independent.
/// @param tile side in pixels; what is left over at the right and lower edges forms smaller tiles
double tiles_p_value(std::span<const pathtracer::Image> a, std::span<const pathtracer::Image> b, std::uint32_t tile);

}  // namespace tandem::test
