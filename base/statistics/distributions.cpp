#include "base/statistics/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tandem::statistics {
namespace {

constexpr double negligible = 1e-15;
constexpr double tiny = 1e-300;
constexpr int most_terms = 100'000;

/// The lower function's series (8.7.1), good for x < a + 1.
double lower_gamma_series(double a, double x) {
  double term = 1.0 / a;
  double sum = term;
  for (int n = 1; n < most_terms && term > negligible * sum; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

/// A denominator of Lentz's method, which must not be 0.
double away_from_zero(double value) { return std::abs(value) < tiny ? tiny : value; }

/// The continued fraction 8.9.2 by the modified method of Lentz (Thompson and Barnett 1986), good for x >= a + 1.
double upper_gamma_fraction(double a, double x) {
  double b = x + 1.0 - a;
  double c = 1.0 / tiny;
  double d = 1.0 / away_from_zero(b);
  double fraction = d;
  for (int n = 1; n < most_terms; ++n) {
    const double numerator = -n * (n - a);
    b += 2.0;
    d = 1.0 / away_from_zero(numerator * d + b);
    c = away_from_zero(b + numerator / c);
    fraction *= d * c;
    if (std::abs(d * c - 1.0) < negligible) break;
  }
  return fraction * std::exp(a * std::log(x) - x - std::lgamma(a));
}

/// The continued fraction 8.17.22, likewise, good for x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
  double c = 1.0;
  double d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
  double fraction = d;
  for (int m = 1; m < most_terms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1.0 / away_from_zero(1.0 + even * d);
    c = away_from_zero(1.0 + even / c);
    fraction *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1.0 / away_from_zero(1.0 + odd * d);
    c = away_from_zero(1.0 + odd / c);
    fraction *= d * c;
    if (std::abs(d * c - 1.0) < negligible) break;
  }
  const double front =
      std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x) - std::log(a);
  return fraction * std::exp(front);
}

}  // namespace

double regularised_upper_gamma(double a, double x) {
  if (!(x > 0.0)) return 1.0;
  if (std::isinf(x)) return 0.0;
  return x < a + 1.0 ? 1.0 - lower_gamma_series(a, x) : upper_gamma_fraction(a, x);
}

double regularised_beta(double a, double b, double x) {
  if (!(x > 0.0)) return 0.0;
  if (x >= 1.0) return 1.0;
  return x < (a + 1.0) / (a + b + 2.0) ? beta_fraction(a, b, x) : 1.0 - beta_fraction(b, a, 1.0 - x);
}

double chi_square_p_value(double statistic, double freedom) {
  return regularised_upper_gamma(0.5 * freedom, 0.5 * statistic);
}

double normal_p_value(double z) { return std::erfc(std::abs(z) / std::numbers::sqrt2); }

double student_p_value(double t, double freedom) {
  return regularised_beta(0.5 * freedom, 0.5, freedom / (freedom + t * t));
}

double sidak(double smallest, std::size_t count) {
  if (smallest >= 1.0) return 1.0;
  return -std::expm1(static_cast<double>(count) * std::log1p(-smallest));
}

}  // namespace tandem::statistics
