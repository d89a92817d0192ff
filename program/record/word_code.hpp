#pragma once

#include <cstdint>

#include "program/record/code.hpp"
#include "program/record/components.hpp"

namespace tandem::program {

/// The type of a component.
std::uint32_t scalar_type(Globals& globals, const Component& component);

/// Writes the instructions that make the words of a component (RecordedWords): word_count() ids of uint.
/// @param scalar the id of its value
void append_words(Code& code, const Component& component, std::uint32_t scalar, std::uint32_t* words);

}  // namespace tandem::program
