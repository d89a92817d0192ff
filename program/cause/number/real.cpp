#include "program/cause/number/real.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tandem::program {
namespace {

__extension__ typedef unsigned __int128 RealBits;

constexpr int stored_bits = 112;  ///< of the mantissa
constexpr int exponent_bias = 16383;
constexpr RealBits sign_bit = static_cast<RealBits>(1) << 127;

int exponent_field(Real x) { return static_cast<int>(std::bit_cast<RealBits>(x) >> stored_bits & 0x7fff); }

Real power_of_two(int exponent) {
  return std::bit_cast<Real>(static_cast<RealBits>(exponent + exponent_bias) << stored_bits);
}

/// The next smaller number. @pre the format has x
Real predecessor(Real x, const Format& format) { return x - ulp(x > 0 ? x - ulp(x, format) / 4 : x, format); }

}  // namespace

Format format_of(std::uint32_t width) {
  if (width == 16) return {16, 10, -14, 15};
  if (width == 64) return {64, 52, -1022, 1023};
  return {};
}

Real infinity() { return std::numeric_limits<double>::infinity(); }
Real not_a_number() { return std::numeric_limits<double>::quiet_NaN(); }
bool is_nan(Real x) { return x != x; }
bool is_infinite(Real x) { return x == infinity() || x == -infinity(); }
bool is_finite(Real x) { return !is_nan(x) && !is_infinite(x); }
bool is_negative(Real x) { return (std::bit_cast<RealBits>(x) & sign_bit) != 0; }

Real absolute(Real x) { return std::bit_cast<Real>(std::bit_cast<RealBits>(x) & ~sign_bit); }

Real truncated(Real x) {
  const int exponent = exponent_field(x) - exponent_bias;
  if (exponent >= stored_bits) return x;
  const RealBits bits = std::bit_cast<RealBits>(x);
  if (exponent < 0) return std::bit_cast<Real>(bits & sign_bit);
  return std::bit_cast<Real>(bits >> (stored_bits - exponent) << (stored_bits - exponent));
}

Real floored(Real x) {
  const Real whole = truncated(x);
  return whole > x ? whole - 1 : whole;
}

Real square_root(Real x) {
  if (!(x > 0) || is_infinite(x)) return x < 0 ? not_a_number() : x;
  const Real first = std::sqrt(static_cast<long double>(x));
  return first + (x - first * first) / (2 * first);  // Newton doubles the 64 bits
}

Real scaled(Real x, int exponent) {
  for (; exponent > 16000; exponent -= 16000) x *= power_of_two(16000);
  for (; exponent < -16000; exponent += 16000) x *= power_of_two(-16000);
  return x * power_of_two(exponent);
}

int exponent_of(Real x) { return exponent_field(x) - exponent_bias; }

int last_digit_of(Real x) {
  const RealBits bits = std::bit_cast<RealBits>(x);
  const auto low = static_cast<std::uint64_t>(bits);
  const auto high = static_cast<std::uint64_t>(bits >> 64 & ((RealBits{1} << (stored_bits - 64)) - 1));
  const int zeros = low != 0 ? std::countr_zero(low) : high != 0 ? 64 + std::countr_zero(high) : stored_bits;
  return exponent_of(x) - stored_bits + zeros;
}

Real sum_tail(Real x, Real y) {
  const Real sum = x + y;
  const Real y_in_sum = sum - x, x_in_sum = sum - y_in_sum;
  return (x - x_in_sum) + (y - y_in_sum);
}

Real largest_finite(const Format& format) {
  return power_of_two(format.largest_exponent) * (2 - power_of_two(-format.mantissa_bits));
}

Real smallest_normal(const Format& format) { return power_of_two(format.smallest_exponent); }

Real ulp(Real x, const Format& format) {
  if (!is_finite(x)) return power_of_two(format.largest_exponent - format.mantissa_bits);
  const int exponent = x == 0 ? format.smallest_exponent : exponent_of(x);
  return power_of_two(std::max(exponent, format.smallest_exponent) - format.mantissa_bits);
}

Real rounded_down(Real x, const Format& format, Real tail) {
  if (!is_finite(x)) return x;
  const Real unit = ulp(x, format);
  Real result = floored(x / unit) * unit;
  if (result == x) result = x;  // with the sign of 0
  if (result == x && tail < 0) result = predecessor(x, format);
  if (result > largest_finite(format)) return largest_finite(format);
  return result < -largest_finite(format) ? -infinity() : result;
}

Real rounded_up(Real x, const Format& format, Real tail) { return -rounded_down(-x, format, -tail); }

Real rounded_to_zero(Real x, const Format& format, Real tail) {
  const bool negative = x == 0 ? tail < 0 : x < 0;
  return negative ? rounded_up(x, format, tail) : rounded_down(x, format, tail);
}

Real rounded_to_nearest(Real x, const Format& format, Real tail) {
  if (!is_finite(x)) return x;
  const Real down = rounded_down(x, format, tail), up = rounded_up(x, format, tail);
  if (down == up) return down;
  // An infinity stands for the number that would follow the largest finite one.
  const Real beyond = power_of_two(format.largest_exponent + 1);
  const Real low = is_infinite(down) ? -beyond : down, high = is_infinite(up) ? beyond : up;
  const Real lean = (x - low) - (high - x) + 2 * tail;
  if (lean != 0) return lean < 0 ? down : up;
  const Real half = low / ulp(low, format) / 2;
  return truncated(half) == half ? down : up;
}

bool is_denormal(Real x, const Format& format) { return x != 0 && absolute(x) < smallest_normal(format); }

Real decoded(std::uint64_t bits, const Format& format) {
  const std::uint64_t mantissa = bits & ((std::uint64_t{1} << format.mantissa_bits) - 1);
  const int largest_field = format.largest_exponent * 2 + 1;
  const int field = static_cast<int>(bits >> format.mantissa_bits) & largest_field;
  const bool negative = (bits >> (format.width - 1) & 1) != 0;
  Real magnitude = static_cast<Real>(mantissa);
  if (field == largest_field) {
    if (mantissa != 0) return not_a_number();
    magnitude = infinity();
  } else {
    if (field != 0) magnitude += power_of_two(format.mantissa_bits);
    magnitude *= power_of_two(std::max(field, 1) - format.largest_exponent - format.mantissa_bits);
  }
  return negative ? -magnitude : magnitude;
}

std::uint64_t encoded(Real x, const Format& format) {
  const std::uint64_t sign = is_negative(x) ? std::uint64_t{1} << (format.width - 1) : 0;
  const auto largest_field = static_cast<std::uint64_t>(format.largest_exponent * 2 + 1);
  if (is_nan(x)) return largest_field << format.mantissa_bits | std::uint64_t{1} << (format.mantissa_bits - 1);
  if (is_infinite(x)) return sign | largest_field << format.mantissa_bits;
  if (x == 0) return sign;
  const Real unit = ulp(x, format);
  const auto digits = static_cast<std::uint64_t>(absolute(x) / unit);
  const int field = exponent_of(unit) + format.mantissa_bits + format.largest_exponent;
  // The leading digit of a normal number adds 1 to the field.
  return sign | ((static_cast<std::uint64_t>(field - 1) << format.mantissa_bits) + digits);
}

}  // namespace tandem::program
