#include "base/statistics/power.hpp"

#include <cmath>
#include <numbers>

#include "base/statistics/distributions.hpp"

namespace tandem::statistics {
namespace {

/// Where an increasing function reaches 0, by bisection to the precision of a double or nearly.
template <typename Function>
double root(Function function, double high) {
  double low = 0;
  while (function(high) < 0) {
    low = high;
    high *= 2;
  }
  for (int i = 0; i < 100 && high - low > 1e-12 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double student_critical_value(double p_value, double freedom) {
  return root([&](double t) { return p_value - student_p_value(t, freedom); }, 1.0);
}

double sidak_single(double p_value, std::size_t count) {
  return -std::expm1(std::log1p(-p_value) / static_cast<double>(count));
}

double shift_power(double shift, double critical, double freedom) {
  // The estimated standard error is s times the true one, where freedom * s^2 has a chi-square distribution; over its
  // density the midpoint rule is summed, as far as anything of it lies.
  constexpr int steps = 400;
  const double spread = 1 / std::sqrt(2 * freedom);
  const double low = std::fmax(0.0, 1 - 10 * spread);
  const double high = 1 + 10 * spread;
  const double scale = std::log(2.0) + 0.5 * freedom * std::log(0.5 * freedom) - std::lgamma(0.5 * freedom) +
                       std::log((high - low) / steps);
  double found = 0;
  double all = 0;
  for (int i = 0; i < steps; ++i) {
    const double s = low + (high - low) * (i + 0.5) / steps;
    const double weight = std::exp(scale + (freedom - 1) * std::log(s) - 0.5 * freedom * s * s);
    found += weight * 0.5 * std::erfc((critical * s - shift) / std::numbers::sqrt2);
    all += weight;
  }
  return found / all;
}

double detectable_shift(double probability, double critical, double freedom) {
  return root([&](double shift) { return shift_power(shift, critical, freedom) - probability; }, critical + 1);
}

}  // namespace tandem::statistics
