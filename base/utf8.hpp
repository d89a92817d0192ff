#pragma once

#include <cstddef>
#include <string_view>

namespace tandem {

/// A character and the bytes that it takes; 0 bytes where the text does not begin with one.
struct Utf8Character {
  std::size_t length = 0;
  char32_t code = 0;
};

/// The character that a text of at least one byte begins with (RFC 3629: no overlong forms, no surrogates).
Utf8Character first_character(std::string_view text);

}  // namespace tandem
