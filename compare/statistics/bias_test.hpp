#pragma once

#include <cstddef>

#include "compare/statistics/batched_estimate.hpp"

/// Whether images that differ in noise are estimates of the same picture, or one of them is biased.
namespace tandem::compare {

/// A mean that both estimates have, over a tile or the whole picture.
struct ComparedMean {
  Tile tile;
  Channel channel = Channel::luminance;
  statistics::Mean a, b;
  double p_value = 1;  ///< of this mean alone, by welch_p_value
  /// (b - a) / a; 0 where a is 0.
  double relative_difference() const;
};

/// p-values: the probability that chance alone makes estimates of the same picture differ that much.
struct BiasTest {
  std::size_t tile_tests = 0;  ///< tiles times channels
  double tiles_p_value = 1;    ///< of the least likely tile, corrected for the number of tests
  double picture_p_value = 1;  ///< of the least likely channel of the whole picture, corrected for their number
  double p_value = 1;          ///< of both together
  ComparedMean worst_tile;     ///< least likely
  ComparedMean worst_mean;     ///< of the whole picture, likewise
  /// Root of the mean squared difference of the two mean images over pixels and channels; pixels with a NaN or an
  /// infinity are left out. Noise alone where there is no bias.
  double rmse = 0;
};

/// Welch's t-test of every tile and of the whole picture, channel by channel; the p-values are corrected by Sidak's
/// formula, which the dependence between channels and tiles only makes stricter.
///
/// Fireflies: the batch with one raises the mean and its error together, so that estimates with the same distribution
/// fail less often than the p-value says, however heavy its tail (Efron, Student's t-test under symmetry conditions,
/// JASA 64, 1969, as differences of batches are then symmetric). Nothing is trimmed, because trimmed means of different
/// samplers would have different limits. Estimates with different distributions have the same p-values only where both
/// are seen: the errors of tiles allow for twenty events that have not happened, each of the size usual in the picture.
/// docs/guide/statistics.md has the measurements.
///
/// At least two batches each. Throws Error for estimates of different sizes or tiles.
BiasTest test_bias(const BatchedEstimate& a, const BatchedEstimate& b);

/// The smallest biases that test_bias would have found.
struct BiasPower {
  double level = 0;        ///< p-values below this are a bias
  double probability = 0;  ///< with which the biases are found
  double picture = 0;      ///< relative, of the whole picture
  double median_tile = 0;  ///< relative, of the luminance of the median tile
  Tile tile;               ///< the median tile: of those that have noise, half know their mean better
};

/// From the noise of the estimates. All members are finite; the biases are 0 where nothing has noise, and any is found.
/// @param level in (0, 1)
BiasPower bias_power(const BatchedEstimate& a, const BatchedEstimate& b, double level, double probability = 0.9);

}  // namespace tandem::compare
