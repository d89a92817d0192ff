#include "base/printable.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "base/utf8.hpp"

namespace tandem {
namespace {

/// Unicode's categories Cc, and of Cf those that change the order of what is shown; the separators of lines too.
bool is_control(char32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x061c || code == 0x200e || code == 0x200f ||
         (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069) || code == 0xfeff;
}

}  // namespace

std::string printable(std::string_view text, std::string_view keep) {
  std::string result;
  result.reserve(text.size());
  const auto out = std::back_inserter(result);
  while (!text.empty()) {
    const Utf8Character character = first_character(text);
    const std::size_t length = std::max<std::size_t>(character.length, 1);
    const auto byte = static_cast<unsigned char>(text.front());
    if (character.length == 0)
      fmt::format_to(out, "\\x{:02x}", byte);
    else if (!is_control(character.code) || (length == 1 && keep.find(text.front()) != std::string_view::npos))
      result += text.substr(0, length);
    else if (text.front() == '\n')
      result += "\\n";
    else if (text.front() == '\t')
      result += "\\t";
    else if (text.front() == '\r')
      result += "\\r";
    else
      fmt::format_to(out, character.code < 0x100 ? fmt::runtime("\\x{:02x}") : fmt::runtime("\\u{:04x}"),
                     static_cast<unsigned>(character.code));
    text.remove_prefix(length);
  }
  return result;
}

std::string shortened(std::string_view name, std::size_t most) {
  // More bytes than that are never needed, whatever their characters.
  constexpr std::size_t widest = 4;
  const auto is_inside = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80; };
  const auto count = static_cast<std::size_t>(
      std::count_if(name.begin(), name.begin() + static_cast<std::ptrdiff_t>(std::min(name.size(), widest * most + 1)),
                    [&](char c) { return !is_inside(c); }));
  if (name.size() <= most || (count <= most && name.size() <= widest * most)) return printable(name);
  std::size_t head = most / 2;
  std::size_t tail = name.size() - most / 4;
  while (head > 0 && is_inside(name[head])) --head;
  while (tail < name.size() && is_inside(name[tail])) ++tail;
  return printable(name.substr(0, head)) + "..." + printable(name.substr(tail));
}

}  // namespace tandem
