#pragma once

#include <cstddef>

/// What a test with a Student distribution would have found.
namespace tandem::statistics {

/// The t beyond which, on both sides, a share of `p_value` of Student's distribution lies; p_value in (0, 1).
double student_critical_value(double p_value, double freedom);

/// The p-value of one of `count` tests that Sidak's correction makes `p_value`.
double sidak_single(double p_value, std::size_t count);

/// Probability that a two-sided test at the critical value `critical` finds a shift of `shift` standard errors, when
/// the standard error is itself estimated with `freedom` degrees of freedom: the noncentral t distribution beyond
/// `critical` (the chance to find it on the wrong side is left out).
double shift_power(double shift, double critical, double freedom);

/// The shift, in standard errors, that is found with `probability`, in (0, 1).
double detectable_shift(double probability, double critical, double freedom);

}  // namespace tandem::statistics
