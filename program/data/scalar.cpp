#include "program/data/scalar.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "base/error.hpp"
#include "base/printable.hpp"

namespace tandem::program {
namespace {

static_assert(std::endian::native == std::endian::little);

std::uint64_t low_bits(std::uint64_t bits, ScalarType scalar) {
  const std::uint32_t width = 8 * size_of(scalar);
  return width == 64 ? bits : bits & ((std::uint64_t{1} << width) - 1);
}

std::int64_t sign_extended(ScalarType scalar, std::uint64_t bits) {
  const std::uint32_t unused = 64 - 8 * size_of(scalar);
  return static_cast<std::int64_t>(bits << unused) >> unused;
}

/// The whole of the text as a number, or none.
template <typename Number, typename... Format>
std::optional<Number> parsed(std::string_view text, Format... format) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, format...);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<std::uint64_t> float_bits(ScalarType scalar, std::string_view text) {
  if (scalar == ScalarType::float64) {
    const std::optional<double> value = parsed<double>(text);
    return value ? std::optional(std::bit_cast<std::uint64_t>(*value)) : std::nullopt;
  }
  const std::optional<float> value = parsed<float>(text);
  if (!value) return std::nullopt;
  return scalar == ScalarType::float16 ? glm::packHalf1x16(*value) : std::bit_cast<std::uint32_t>(*value);
}

std::optional<std::uint64_t> whole_bits(ScalarType scalar, std::string_view text) {
  if (is_signed(scalar)) {
    const std::optional<std::int64_t> value = parsed<std::int64_t>(text);
    if (!value) return std::nullopt;
    const std::uint64_t bits = low_bits(static_cast<std::uint64_t>(*value), scalar);
    return sign_extended(scalar, bits) == *value ? std::optional(bits) : std::nullopt;
  }
  const std::optional<std::uint64_t> value = parsed<std::uint64_t>(text);
  return value && low_bits(*value, scalar) == *value ? value : std::nullopt;
}

}  // namespace

std::uint64_t bits_at(std::span<const std::byte> bytes, const Place& place) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, bytes.data() + place.offset, size_of(place.scalar));
  return bits;
}

void set_bits(std::span<std::byte> bytes, const Place& place, std::uint64_t bits) {
  std::memcpy(bytes.data() + place.offset, &bits, size_of(place.scalar));
}

double number_of(ScalarType scalar, std::uint64_t bits) {
  switch (scalar) {
    case ScalarType::float16:
      return static_cast<double>(glm::unpackHalf1x16(static_cast<std::uint16_t>(bits)));
    case ScalarType::float32:
      return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    case ScalarType::float64:
      return std::bit_cast<double>(bits);
    default:
      return is_signed(scalar) ? static_cast<double>(sign_extended(scalar, bits)) : static_cast<double>(bits);
  }
}

std::uint64_t bits_of_whole(ScalarType scalar, std::uint64_t number) {
  return is_floating(scalar) ? bits_of_number(scalar, static_cast<double>(number)) : low_bits(number, scalar);
}

std::uint64_t bits_of_number(ScalarType scalar, double number) {
  switch (scalar) {
    case ScalarType::float16:
      return glm::packHalf1x16(static_cast<float>(number));
    case ScalarType::float32:
      return std::bit_cast<std::uint32_t>(static_cast<float>(number));
    case ScalarType::float64:
      return std::bit_cast<std::uint64_t>(number);
    default:
      break;
  }
  if (std::isnan(number)) return 0;
  const int bits = static_cast<int>(8 * size_of(scalar));
  const double end = std::ldexp(1.0, is_signed(scalar) ? bits - 1 : bits);  // the first number beyond the range
  const double least = is_signed(scalar) ? -end : 0.0;
  if (number <= least) return is_signed(scalar) ? std::uint64_t{1} << (bits - 1) : 0;
  if (number >= end) {
    const std::uint64_t largest = low_bits(~std::uint64_t{0}, scalar);
    return is_signed(scalar) ? largest >> 1 : largest;
  }
  if (number < 0) return low_bits(static_cast<std::uint64_t>(static_cast<std::int64_t>(number)), scalar);
  return static_cast<std::uint64_t>(number);
}

std::string to_text(ScalarType scalar, std::uint64_t bits) {
  if (scalar == ScalarType::float64) return fmt::format("{}", std::bit_cast<double>(bits));
  if (is_floating(scalar)) return fmt::format("{}", static_cast<float>(number_of(scalar, bits)));
  return is_signed(scalar) ? fmt::format("{}", sign_extended(scalar, bits)) : fmt::format("{}", bits);
}

std::uint64_t from_text(ScalarType scalar, std::string_view text) {
  std::optional<std::uint64_t> bits;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    bits = parsed<std::uint64_t>(text.substr(2), 16);
    if (bits && low_bits(*bits, scalar) != *bits) bits.reset();
  } else {
    const std::string_view unsigned_text = text.starts_with('+') ? text.substr(1) : text;
    bits = is_floating(scalar) ? float_bits(scalar, unsigned_text) : whole_bits(scalar, unsigned_text);
  }
  if (!bits) throw Error(fmt::format("'{}' is no {}", shortened(text), name_of(scalar)));
  return *bits;
}

}  // namespace tandem::program
