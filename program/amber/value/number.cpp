#include "program/amber/value/number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace tandem::program::amber {
namespace {

constexpr int half_mantissa_bits = 10;
constexpr int half_smallest_exponent = -14;

std::optional<std::uint64_t> parse_integer(std::string_view digits, int base) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

std::optional<Number> parse_floating(std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // from_chars does not say whether it was too large or too small.
    value = std::strtod(std::string(word).c_str(), nullptr);
  } else if (error != std::errc()) {
    return std::nullopt;
  }
  return Number{.floating = true, .value = value};
}

template <typename T>
void put(std::span<std::byte> bytes, T value) {
  std::memcpy(bytes.data(), &value, sizeof(T));
}

template <typename T>
T get(std::span<const std::byte> bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

Number signed_number(std::int64_t value) {
  return {.negative = value < 0, .bits = static_cast<std::uint64_t>(value), .value = static_cast<double>(value)};
}

Number unsigned_number(std::uint64_t value) { return {.bits = value, .value = static_cast<double>(value)}; }

Number floating_number(double value) { return {.floating = true, .value = value}; }

}  // namespace

std::optional<Number> parse_number(std::string_view word) {
  const bool negative = word.starts_with('-');
  const std::string_view magnitude = word.substr(negative ? 1 : 0);
  if (magnitude.empty()) return std::nullopt;
  if (magnitude.size() == 3) {
    const auto is = [&](std::size_t i, char c) { return magnitude[i] == c || magnitude[i] == c - 'a' + 'A'; };
    if (is(0, 'n') && is(1, 'a') && is(2, 'n')) return floating_number(std::numeric_limits<double>::quiet_NaN());
  }
  const char first = magnitude.front();
  if (!(first >= '0' && first <= '9') && !(first == '.' && magnitude.size() > 1)) return std::nullopt;
  const bool hexadecimal = magnitude.starts_with("0x") || magnitude.starts_with("0X");
  if (!hexadecimal && magnitude.find_first_not_of("0123456789") != std::string_view::npos) return parse_floating(word);
  const std::optional<std::uint64_t> value =
      hexadecimal ? parse_integer(magnitude.substr(2), 16) : parse_integer(magnitude, 10);
  if (!value) return std::nullopt;
  if (!negative) return Number{.hexadecimal = hexadecimal, .bits = *value, .value = static_cast<double>(*value)};
  if (*value > std::uint64_t{1} << 63) return std::nullopt;
  // A minus in front of 0 is kept by the floating-point value.
  return Number{
      .negative = *value != 0, .hexadecimal = hexadecimal, .bits = ~*value + 1, .value = -static_cast<double>(*value)};
}

bool fits(const Number& number, ScalarType scalar) {
  if (is_floating(scalar)) return true;
  if (number.floating) return false;
  const std::uint32_t bits = 8 * size_of(scalar);
  if (bits == 64) return true;
  if (number.negative) return static_cast<std::int64_t>(number.bits) >= -(std::int64_t{1} << (bits - 1));
  return number.bits < std::uint64_t{1} << bits;
}

void write(std::span<std::byte> bytes, ScalarType scalar, const Number& number) {
  switch (scalar) {
    case ScalarType::int8:
    case ScalarType::uint8:
      return put(bytes, static_cast<std::uint8_t>(number.bits));
    case ScalarType::int16:
    case ScalarType::uint16:
      return put(bytes, static_cast<std::uint16_t>(number.bits));
    case ScalarType::int32:
    case ScalarType::uint32:
      return put(bytes, static_cast<std::uint32_t>(number.bits));
    case ScalarType::int64:
    case ScalarType::uint64:
      return put(bytes, number.bits);
    case ScalarType::float16:
      return put(bytes, to_half(number.value));
    case ScalarType::float32:
      return put(bytes, static_cast<float>(number.value));
    case ScalarType::float64:
      return put(bytes, number.value);
  }
}

Number read(std::span<const std::byte> bytes, ScalarType scalar) {
  switch (scalar) {
    case ScalarType::int8:
      return signed_number(get<std::int8_t>(bytes));
    case ScalarType::uint8:
      return unsigned_number(get<std::uint8_t>(bytes));
    case ScalarType::int16:
      return signed_number(get<std::int16_t>(bytes));
    case ScalarType::uint16:
      return unsigned_number(get<std::uint16_t>(bytes));
    case ScalarType::int32:
      return signed_number(get<std::int32_t>(bytes));
    case ScalarType::uint32:
      return unsigned_number(get<std::uint32_t>(bytes));
    case ScalarType::int64:
      return signed_number(get<std::int64_t>(bytes));
    case ScalarType::uint64:
      return unsigned_number(get<std::uint64_t>(bytes));
    case ScalarType::float16:
      return floating_number(from_half(get<std::uint16_t>(bytes)));
    case ScalarType::float32:
      return floating_number(get<float>(bytes));
    case ScalarType::float64:
      return floating_number(get<double>(bytes));
  }
  return {};
}

std::string text_of(const Number& number, ScalarType scalar) {
  if (scalar == ScalarType::float32) return fmt::format("{}", static_cast<float>(number.value));
  if (number.floating) return fmt::format("{}", number.value);
  if (number.negative) return fmt::format("{}", static_cast<std::int64_t>(number.bits));
  return fmt::format("{}", number.bits);
}

std::uint16_t to_half(double value) {
  const std::uint16_t sign = std::signbit(value) ? 0x8000 : 0;
  const double magnitude = std::fabs(value);
  if (std::isnan(value)) return static_cast<std::uint16_t>(sign | 0x7e00);
  if (magnitude == 0) return sign;
  if (std::isinf(value)) return static_cast<std::uint16_t>(sign | 0x7c00);
  int exponent = 0;
  std::frexp(magnitude, &exponent);
  exponent = std::max(exponent - 1, half_smallest_exponent);
  // The mantissa with its leading one, or without for subnormal numbers; the carry of rounding raises the exponent.
  const double scaled = std::ldexp(magnitude, half_mantissa_bits - std::min(exponent, 16));
  const auto mantissa = static_cast<std::uint32_t>(std::nearbyint(std::min(scaled, 4096.0)));
  const std::uint32_t bits = static_cast<std::uint32_t>(exponent - half_smallest_exponent) * 1024u + mantissa;
  return static_cast<std::uint16_t>(sign | (bits >= 0x7c00 ? 0x7c00 : bits));
}

double from_half(std::uint16_t bits) {
  const int exponent = (bits >> half_mantissa_bits) & 31;
  const int mantissa = bits & 1023;
  double value = 0;
  if (exponent == 31) {
    value = mantissa == 0 ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  } else if (exponent == 0) {
    value = std::ldexp(mantissa, half_smallest_exponent - half_mantissa_bits);
  } else {
    value = std::ldexp(1024 + mantissa, exponent + half_smallest_exponent - 1 - half_mantissa_bits);
  }
  return (bits & 0x8000) != 0 ? -value : value;
}

}  // namespace tandem::program::amber
