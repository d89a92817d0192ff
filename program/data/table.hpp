#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/job/value_type.hpp"

/// Values as text: what a person, a spreadsheet or a script writes and reads.
namespace tandem::program {

/// The words of a text, separated by commas, semicolons or white space.
std::vector<std::string> value_words(std::string_view text);

/// The numbers of a CSV or text file. A first line of names is skipped; of a file whose first line is "name,value" only
/// the second column counts. Throws Error, naming the file.
std::vector<std::string> read_table(const std::filesystem::path& path);

/// An array: a line for each element, under a line with the names of its scalars ("value" for an element that is one
/// scalar). Anything else: a line "name,value" for each scalar.
std::string to_csv(const ValueType& type, std::span<const std::byte> bytes);

/// What to_csv writes, in columns, with an index in front of the elements of an array, at most `lines` lines of values.
std::string to_columns(const ValueType& type, std::span<const std::byte> bytes, std::size_t lines);

}  // namespace tandem::program
