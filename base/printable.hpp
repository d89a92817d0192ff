#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Texts from files, as a terminal may show them.
namespace tandem {

/// The text with its control characters and what is no UTF-8 written as escapes: \n, \t, \x1b, \u202e. Characters that
/// reorder text count as control characters. @param keep control characters that stay: "\n" for a text of several lines
std::string printable(std::string_view text, std::string_view keep = "");

/// A name for a sentence: printable, and of more than `most` characters only the beginning and the end.
std::string shortened(std::string_view name, std::size_t most = 100);

}  // namespace tandem
