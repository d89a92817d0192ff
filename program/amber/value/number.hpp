#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "program/job/value_type.hpp"

/// Numbers as a script writes them, and as they lie in memory.
namespace tandem::program::amber {

/// A literal: an integer (its bits in two's complement), or a floating-point number.
struct Number {
  bool floating = false;
  bool negative = false;  ///< of an integer
  bool hexadecimal = false;
  std::uint64_t bits = 0;
  double value = 0;  ///< also of an integer
};

/// The whole word as a number: 12, -3, 0xff, 1.5, 1e-3, nan. Empty when it is none, or an integer of more than 64 bits.
std::optional<Number> parse_number(std::string_view word);

/// Whether the scalar can hold the number: an integer in the range of the type or of its unsigned or signed twin (0xff
/// is a bit pattern of int8), no fraction in an integer type. Every number fits a floating-point type.
bool fits(const Number& number, ScalarType scalar);

/// Writes the number into the first bytes, rounded to nearest even for a floating-point type.
/// @pre fits() (of a larger integer the lowest bits are written), and as many bytes as the scalar has
void write(std::span<std::byte> bytes, ScalarType scalar, const Number& number);

/// What the first bytes hold: exact for every type but 64-bit integers, whose `bits` are.
Number read(std::span<const std::byte> bytes, ScalarType scalar);

/// What read() has given, as it reads in a sentence.
std::string text_of(const Number& number, ScalarType scalar);

/// The bits of a 16-bit float, rounded to nearest even, and back.
std::uint16_t to_half(double value);
double from_half(std::uint16_t bits);

}  // namespace tandem::program::amber
