#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "program/amber/position.hpp"
#include "program/amber/value/number.hpp"

namespace tandem::program::amber {

struct Token {
  enum class Kind { word, number, string, end_of_line, end };

  Kind kind = Kind::end;
  std::string text;  ///< as it stands in the script; of a string without its quotes
  Number number = {};
  Position position;

  bool is(std::string_view word) const { return kind == Kind::word && text == word; }
  bool ends_line() const { return kind == Kind::end_of_line || kind == Kind::end; }
};

/// Cuts a script into words, numbers and ends of lines. A comment goes from # to the end of its line, and a line ends
/// not where its last word is a backslash.
class Lexer {
 public:
  /// @param text outlives the lexer
  explicit Lexer(std::string_view text) : text_(text) {}

  Token next();
  /// The next token, which next() still returns.
  Token peek() const;
  /// Where the next token begins, once spaces are skipped.
  Position position() const;

  /// The text up to the word END, which is passed over too, from the next line on: a shader, which has comments of its
  /// own. False when there is no END; then nothing is passed over.
  bool take_block(std::string& block);
  /// The lines before the next that begins with the character, or all that are left.
  std::string take_lines_to(char first);

 private:
  void advance();
  void skip_blanks();
  Token read_string();

  std::string_view text_;
  std::size_t offset_ = 0;
  Position position_;
};

}  // namespace tandem::program::amber
