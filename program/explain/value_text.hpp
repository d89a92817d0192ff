#pragma once

#include <optional>
#include <string>

#include "program/cause/judgement.hpp"

namespace tandem::program {

/// "1.5", "(1, 2.25, -0)", "true": enough digits to tell two floats apart. Values of more than 16 scalars are cut.
std::string value_text(const RecordedWords& value);

/// The bits, in hexadecimal: "0x3fc00000". Of a value of several scalars, those of one. @param component its position
std::string bits_text(const RecordedWords& value, std::size_t component);

/// The first scalar in which the values differ. @pre one does
std::size_t first_other_component(const RecordedWords& a, const RecordedWords& b);

/// Floats between the two, of the same width; nothing where one is NaN or they are no floats.
std::optional<std::uint64_t> ulp_distance(const RecordedWords& a, const RecordedWords& b, std::size_t component);

}  // namespace tandem::program
