#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/job/value_type.hpp"

/// First contents of buffers.
namespace tandem::program {

/// Bytes of a value of the type whose array without a length, if it has one, holds `elements` elements. At least 1.
std::uint64_t size_with(const ValueType& type, std::uint64_t elements);

/// The array without a length that the type is or ends with; null without one.
const ValueType* unsized_array(const ValueType& type);

/// Scalar number i becomes i; beyond the range of a small type the numbers begin again.
void fill_iota(std::span<std::byte> bytes, const ValueType& type);

/// Independent uniform numbers, the same for the same seed on every machine: floats in [minimum, maximum), whole
/// numbers from minimum to maximum.
void fill_random(std::span<std::byte> bytes, const ValueType& type, std::uint64_t seed, double minimum, double maximum);

/// The texts become the scalars in their order. Throws Error for one that is no number of its scalar's type, with the
/// scalar's name, or where there are more texts than scalars. Scalars without a text keep their values.
void fill_values(std::span<std::byte> bytes, const ValueType& type, std::span<const std::string> texts);

/// How many elements the type's array without a length needs for so many scalars: the least number that holds them.
std::uint64_t elements_for(const ValueType& type, std::uint64_t scalars);

/// The texts become the scalars of a part of the value, "position[3]" or "position[3].y", in their order. Throws Error
/// for a part that the type does not have, with the names of its scalars, and as fill_values does.
void fill_part(std::span<std::byte> bytes, const ValueType& type, std::string_view part,
               std::span<const std::string> texts);

}  // namespace tandem::program
