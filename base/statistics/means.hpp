#pragma once

#include <span>

/// Whether two ways to estimate something give the same.
namespace tandem::statistics {

struct Mean {
  double value = 0;
  double standard_error = 0;  ///< of the value, from the spread of the samples
  double count = 0;           ///< of samples
};

/// Of independent samples; at least two.
Mean mean_of(std::span<const double> samples);

/// Deviation of a mean from a known value, in standard errors; 0 / 0 is 0.
double z_score(const Mean& mean, double truth);

/// Of the difference of two means: the standard error, and the degrees of freedom with which it is known (Welch 1947,
/// Satterthwaite 1946); 0 for means without any spread.
struct DifferenceError {
  double standard_error = 0;
  double freedom = 0;
};
DifferenceError difference_error(const Mean& a, const Mean& b);

/// Two-sided p-value of Welch's test that two means estimate the same value. Means within 1e-6 of each other,
/// relatively, are equal, whatever their spread.
double welch_p_value(const Mean& a, const Mean& b);

}  // namespace tandem::statistics
