#include "program/print/print_format.hpp"

#include <bit>
#include <utility>

#include <fmt/format.h>
#include <fmt/printf.h>

#include "base/error.hpp"
#include "base/printable.hpp"

namespace tandem::program {
namespace {

constexpr std::string_view integer_letters = "diouxX", float_letters = "aAeEfFgG", digits = "0123456789";

bool is_one_of(std::string_view letters, char letter) { return letters.find(letter) != std::string_view::npos; }

/// Reads the conversions of a format one after the other.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  PrintFormat parse() {
    PrintFormat format;
    std::string text;
    while (position_ < text_.size()) {
      if (text_[position_] != '%') {
        text.push_back(text_[position_++]);
        continue;
      }
      start_ = position_++;
      if (take('%')) {
        text.push_back('%');
        continue;
      }
      format.conversions.push_back(conversion());
      format.conversions.back().text = std::exchange(text, {});
    }
    format.end = std::move(text);
    return format;
  }

 private:
  bool take(char letter) {
    const bool is_there = position_ < text_.size() && text_[position_] == letter;
    position_ += is_there ? 1 : 0;
    return is_there;
  }

  void take_all(std::string_view letters) {
    while (position_ < text_.size() && is_one_of(letters, text_[position_])) ++position_;
  }

  void take_number() {
    constexpr std::size_t most_digits = 3;
    const std::size_t first = position_;
    take_all(digits);
    if (position_ - first > most_digits) fail("has a width or a precision of more than three digits");
  }

  Conversion conversion() {
    const std::size_t flags = position_;
    take_all("-+ #0");
    take_number();
    if (take('.')) take_number();
    Conversion result{.text = {}, .flags = std::string(text_.substr(flags, position_ - flags))};
    if (take('v')) {
      if (position_ == text_.size() || !is_one_of("234", text_[position_]))
        fail("is no vector of 2, 3 or 4 components, as in %v3f");
      result.components = static_cast<std::uint32_t>(text_[position_++] - '0');
    }
    const bool is_long = take('l');
    if (position_ == text_.size()) fail("has no letter that says what is printed");
    result.letter = text_[position_++];
    if (!is_long && result.letter == 'u') take('l');  // %ul is %lu
    const bool is_integer = is_one_of(integer_letters, result.letter);
    if (!is_integer && (is_long || !is_one_of(float_letters, result.letter)))
      fail(
          "is no conversion of debugPrintfEXT; there are d i o u x X, these with an l, a A e E f F g G, and vectors "
          "of them, as in %v3f");
    return result;
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw Error(fmt::format("'{}' {}", printable(text_.substr(start_, position_ - start_)), why));
  }

  std::string_view text_;
  std::size_t position_ = 0, start_ = 0;
};

std::string kind_text(const std::vector<Component>& argument) {
  const bool is_float = argument.front().kind == ComponentKind::floating;
  const char* const what = is_float ? "float" : "whole number";
  return argument.size() == 1 ? fmt::format("a {}", what) : fmt::format("a vector of {} {}s", argument.size(), what);
}

/// @param words the component's
std::string component_text(const std::string& piece, char letter, const Component& component,
                           std::span<const std::uint32_t> words) {
  const std::uint64_t bits = words[0] | (component.width == 64 ? std::uint64_t{words[1]} << 32 : 0);
  if (component.kind == ComponentKind::floating)
    return fmt::sprintf(piece, component.width == 64 ? std::bit_cast<double>(bits)
                                                     : static_cast<double>(std::bit_cast<float>(words[0])));
  if (letter != 'd' && letter != 'i') return fmt::sprintf(piece, bits);
  const unsigned unused = 64 - component.width;
  return fmt::sprintf(piece, static_cast<std::int64_t>(bits << unused) >> unused);
}

}  // namespace

std::string Conversion::name() const {
  return fmt::format("%{}{}{}", flags, components > 1 ? fmt::format("v{}", components) : "", letter);
}

PrintFormat parse_print_format(std::string_view text) { return Parser(text).parse(); }

void check_arguments(const PrintFormat& format, std::span<const std::vector<Component>> arguments) {
  if (arguments.size() < format.conversions.size())
    throw Error(fmt::format("'{}' has no argument: {} follow the format, which has {} conversions",
                            format.conversions[arguments.size()].name(), arguments.size(), format.conversions.size()));
  for (std::size_t i = 0; i < format.conversions.size(); ++i) {
    const Conversion& conversion = format.conversions[i];
    const std::vector<Component>& argument = arguments[i];
    const bool is_float = is_one_of(float_letters, conversion.letter);
    if (is_float != (argument.front().kind == ComponentKind::floating) || argument.size() != conversion.components)
      throw Error(fmt::format("'{}' is given {}", conversion.name(), kind_text(argument)));
  }
}

std::string print_text(const PrintFormat& format, std::span<const std::vector<Component>> arguments,
                       std::span<const std::uint32_t> words) {
  std::string text;
  for (std::size_t i = 0; i < format.conversions.size(); ++i) {
    const Conversion& conversion = format.conversions[i];
    const std::string piece = fmt::format("%{}{}", conversion.flags, conversion.letter);
    text += conversion.text;
    for (const Component& component : arguments[i]) {
      if (component.word != 0) text += ", ";
      text += component_text(piece, conversion.letter, component, words.subspan(component.word));
    }
    words = words.subspan(word_count(arguments[i]));
  }
  return text + format.end;
}

}  // namespace tandem::program
