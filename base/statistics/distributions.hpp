#pragma once

#include <cstddef>

/// Probabilities with which chance alone gives a statistic at least as extreme: p-values.
namespace tandem::statistics {

/// The regularised upper incomplete gamma function Q(a, x), a > 0, x >= 0 (NIST Digital Library of Mathematical
/// Functions, 8.2.4). Relative error below 1e-10 where the result is above 1e-300.
double regularised_upper_gamma(double a, double x);

/// The regularised incomplete beta function I_x(a, b), a, b > 0, x in [0, 1] (likewise, 8.17.2). Relative error below
/// 1e-10.
double regularised_beta(double a, double b, double x);

/// Of a chi-square statistic; `freedom` > 0.
double chi_square_p_value(double statistic, double freedom);

/// Two-sided, of a standard normal deviate.
double normal_p_value(double z);

/// Two-sided, of Student's t; `freedom` > 0.
double student_p_value(double t, double freedom);

/// That the smallest of `count` independent p-values is at most `smallest` (Sidak 1967): the p-value of a family of
/// tests.
double sidak(double smallest, std::size_t count);

}  // namespace tandem::statistics
