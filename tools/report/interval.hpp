#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// What repeated measurements say, whatever their distribution.
namespace tandem::tools {

/// Values between which the median lies with a probability.
struct MedianInterval {
  double median = 0;
  double least = 0, most = 0;
  double confidence = 0;  ///< that the median of the distribution lies within: at least what was asked for, or all
                          ///< that so few values can give
};

/// The interval between two order statistics: of n independent values the median of their distribution lies between the
/// k-th smallest and the k-th largest with probability 1 - 2 P(B < k), B binomial (n, 1/2) (David and Nagaraja, Order
/// Statistics, 2003, 7.1). The narrowest that reaches `confidence`; the least and the most value where none does, as
/// for fewer than six values and 0.95. @param values at least one
MedianInterval median_interval(std::vector<double> values, double confidence = 0.95);

/// That of reference[i] / values[i]: what slows a machine for a while slows both of a round. As many of each.
MedianInterval ratio_interval(std::span<const double> reference, std::span<const double> values,
                              double confidence = 0.95);

/// Half the values lie within this share of the median: the interquartile range over the median.
double relative_noise(std::vector<double> values);

}  // namespace tandem::tools
