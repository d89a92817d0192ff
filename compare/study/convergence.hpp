#pragma once

#include <span>

/// How fast an error falls.
namespace tandem::study {

/// A line through points by least squares.
struct Line {
  double slope = 0;
  double intercept = 0;
  double slope_error = 0;  ///< standard error of the slope; 0 for two points
};

/// @param x at least two different ones @param y as many
Line fit_line(std::span<const double> x, std::span<const double> y);

/// The line through (log count, log error): its slope is the order of convergence, -1/2 for independent samples. All
/// numbers positive.
Line convergence(std::span<const double> counts, std::span<const double> errors);

}  // namespace tandem::study
