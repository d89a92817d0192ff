#include "tools/plot/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tandem::tools {
namespace {

/// The smallest of 1, 2, 5 and 10 times a power of ten that is not less.
double rounded_up(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  constexpr double slack = 1 + 1e-9;  // 0.1 / 0.1 is a little more than 1
  for (const double digit : {1.0, 2.0, 5.0})
    if (step <= digit * power * slack) return digit * power;
  return 10 * power;
}

}  // namespace

Ticks linear_ticks(double least, double most, int count) {
  if (!(most > least)) {
    const double half = least == 0 ? 1 : std::fabs(least) / 2;
    return linear_ticks(least - half, least + half, count);
  }
  const double step = rounded_up((most - least) / std::max(count, 1));
  const double first = std::floor(least / step + 1e-9), last = std::ceil(most / step - 1e-9);
  Ticks ticks{.least = first * step, .most = last * step, .values = {}};
  for (double i = first; i <= last; ++i) ticks.values.push_back(i * step);
  return ticks;
}

Ticks logarithmic_ticks(double least, double most) {
  constexpr double slack = 1e-9;
  double first = std::floor(std::log10(least) + slack), last = std::ceil(std::log10(most) - slack);
  if (!(last > first)) last = first + 1;
  Ticks ticks{.least = std::pow(10.0, first), .most = std::pow(10.0, last), .values = {}};
  const double every = std::ceil((last - first) / 8);
  for (double i = first; i <= last; i += every)
    for (const double digit : {1.0, 2.0, 5.0})
      if (const double value = digit * std::pow(10.0, i);
          (digit == 1 || last - first <= 2) && value <= ticks.most * (1 + slack))
        ticks.values.push_back(value);
  return ticks;
}

std::string tick_text(double value) {
  if (std::fabs(value) < 1e-12) return "0";
  return fmt::format("{:.6g}", value);
}

}  // namespace tandem::tools
