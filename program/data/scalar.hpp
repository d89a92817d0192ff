#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "program/job/value_type.hpp"

/// One scalar of a value in memory. Bytes are those of this machine: little-endian.
namespace tandem::program {

/// The bits, from the lowest one on. @pre the place lies within the bytes
std::uint64_t bits_at(std::span<const std::byte> bytes, const Place& place);
void set_bits(std::span<std::byte> bytes, const Place& place, std::uint64_t bits);

/// The number that the bits mean; exact, but for whole numbers of 64 bits.
double number_of(ScalarType scalar, std::uint64_t bits);

/// The bits of a whole number; of a float the nearest one.
std::uint64_t bits_of_whole(ScalarType scalar, std::uint64_t number);
/// The bits of the nearest float, or of the number without its fraction, within the range of the type; of NaN 0.
std::uint64_t bits_of_number(ScalarType scalar, double number);

/// The shortest text that from_text makes the same bits of, but for the payload of a NaN.
std::string to_text(ScalarType scalar, std::uint64_t bits);

/// The bits of a number in a text: "7", "-1.5e3", "nan", "inf", and for every type its bits as "0x3f800000". Throws
/// Error, which quotes the text, for anything else and for a number out of the type's range.
std::uint64_t from_text(ScalarType scalar, std::string_view text);

}  // namespace tandem::program
