#include "tools/output/xml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "base/utf8.hpp"

namespace tandem::tools {
namespace {

/// Bytes of the character that `text` begins with, or 0 when it is no UTF-8 or XML 1.0 does not allow it (section 2.2).
std::size_t character_length(std::string_view text) {
  const Utf8Character character = first_character(text);
  if (character.code == 0xfffe || character.code == 0xffff) return 0;
  return character.code >= 0x20 || character.code == '\t' || character.code == '\n' || character.code == '\r'
             ? character.length
             : 0;
}

}  // namespace

std::string xml_text(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const char first = text.front();
    if (length == 0) {
      result += "\xef\xbf\xbd";
    } else if (first == '&') {
      result += "&amp;";
    } else if (first == '<') {
      result += "&lt;";
    } else if (first == '>') {
      result += "&gt;";
    } else if (first == '"') {
      result += "&quot;";
    } else if (first == '\t' || first == '\n' || first == '\r') {
      fmt::format_to(std::back_inserter(result), "&#{};", static_cast<int>(first));
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

}  // namespace tandem::tools
