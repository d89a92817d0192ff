#include "tests/rhi_cpu/translate/half_reference.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace tandem::test {

double half_value(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31;
  const double significand = bits & 1023;
  double magnitude = exponent == 0 ? std::ldexp(significand, -24) : std::ldexp(1024.0 + significand, exponent - 25);
  if (exponent == 31)
    magnitude = significand == 0 ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  return (bits & 0x8000) != 0 ? -magnitude : magnitude;
}

std::uint16_t nearest_half(double value) {
  if (std::isnan(value)) return 0x7e00;
  const int sign = std::signbit(value) ? 0x8000 : 0;
  const double magnitude = std::fabs(value);
  if (magnitude >= 65520.0) return static_cast<std::uint16_t>(sign | 0x7c00);
  const int exponent = magnitude == 0.0 ? -14 : std::max(std::ilogb(magnitude), -14);
  // 1024 and more for a normal number; what rounds to 2048 carries into the exponent.
  const int significand = static_cast<int>(std::nearbyint(std::ldexp(magnitude, 10 - exponent)));
  const int bits = significand < 1024 ? significand : ((exponent + 15) << 10) + (significand - 1024);
  return static_cast<std::uint16_t>(sign | bits);
}

bool is_half_nan(std::uint16_t bits) { return (bits & 0x7fff) > 0x7c00; }

int half_distance(std::uint16_t a, std::uint16_t b) {
  if (is_half_nan(a) || is_half_nan(b)) return is_half_nan(a) && is_half_nan(b) ? 0 : 1 << 16;
  const auto place = [](std::uint16_t bits) { return (bits & 0x8000) != 0 ? -(bits & 0x7fff) : bits & 0x7fff; };
  // Zeros of different signs are different.
  if (place(a) == 0 && place(b) == 0) return a != b ? 1 : 0;
  return std::abs(place(a) - place(b));
}

}  // namespace tandem::test
