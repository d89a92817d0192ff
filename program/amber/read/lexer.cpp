#include "program/amber/read/lexer.hpp"

#include <algorithm>

namespace tandem::program::amber {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\0'; }

bool is_mark(char c) { return c == ',' || c == '(' || c == ')'; }

bool ends_word(char c) { return is_blank(c) || c == '\n' || is_mark(c); }

bool is_identifier_part(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

char escaped(char c) {
  constexpr std::string_view letters = "abtnvfr";
  constexpr std::string_view values = "\a\b\t\n\v\f\r";
  const std::size_t i = letters.find(c);
  return i == std::string_view::npos ? c : values[i];
}

/// How many characters of the word are a number: "0.5%" is 0.5 and a word.
std::size_t number_length(std::string_view word) {
  const bool has_sign = word.starts_with('-');
  if (word.substr(has_sign ? 1 : 0).starts_with("0x")) return word.size();
  std::size_t length = word.find_first_not_of("0123456789.", has_sign ? 1 : 0);
  if (length == std::string_view::npos) return word.size();
  if (word[length] == 'e' || word[length] == 'E') {
    const std::size_t digits = length + (word.substr(length + 1).find_first_of("+-") == 0 ? 2 : 1);
    const std::size_t end = std::min(word.find_first_not_of("0123456789", digits), word.size());
    if (digits < end) length = end;
  }
  return length;
}

bool may_begin_number(std::string_view word) {
  if (word.starts_with('-')) word.remove_prefix(1);
  if (word.starts_with('.')) word.remove_prefix(1);
  return !word.empty() && word.front() >= '0' && word.front() <= '9';
}

}  // namespace

void Lexer::advance() {
  if (text_[offset_] == '\n') {
    ++position_.line;
    position_.column = 1;
  } else {
    ++position_.column;
  }
  ++offset_;
}

void Lexer::skip_blanks() {
  while (offset_ < text_.size()) {
    const char c = text_[offset_];
    if (is_blank(c)) {
      advance();
    } else if (c == '#') {
      while (offset_ < text_.size() && text_[offset_] != '\n') advance();
    } else if (c == '\\') {
      std::size_t end = offset_ + 1;
      if (end < text_.size() && text_[end] == '\r') ++end;
      if (end >= text_.size() || text_[end] != '\n') return;
      while (offset_ <= end) advance();
    } else {
      return;
    }
  }
}

Position Lexer::position() const { return peek().position; }

Token Lexer::peek() const {
  Lexer copy = *this;
  return copy.next();
}

Token Lexer::read_string() {
  Token token = {.kind = Token::Kind::string, .text = {}, .position = position_};
  advance();
  while (offset_ < text_.size() && text_[offset_] != '"') {
    if (text_[offset_] == '\\' && offset_ + 1 < text_.size()) {
      advance();
      token.text += escaped(text_[offset_]);
    } else {
      token.text += text_[offset_];
    }
    advance();
  }
  if (offset_ < text_.size()) advance();
  return token;
}

Token Lexer::next() {
  skip_blanks();
  if (offset_ >= text_.size()) return {.kind = Token::Kind::end, .text = {}, .position = position_};
  if (text_[offset_] == '\n') {
    const Token token = {.kind = Token::Kind::end_of_line, .text = {}, .position = position_};
    advance();
    return token;
  }
  if (text_[offset_] == '"') return read_string();

  std::size_t length = 1;
  if (!is_mark(text_[offset_]))
    while (offset_ + length < text_.size() && !ends_word(text_[offset_ + length])) ++length;
  std::string_view word = text_.substr(offset_, length);
  Token token = {.kind = Token::Kind::word, .text = {}, .position = position_};
  if (const std::optional<Number> whole = parse_number(word)) {
    token.kind = Token::Kind::number;
    token.number = *whole;
  } else if (may_begin_number(word)) {
    const std::string_view beginning = word.substr(0, number_length(word));
    if (const std::optional<Number> number = parse_number(beginning)) {
      token.kind = Token::Kind::number;
      token.number = *number;
      word = beginning;
    }
  }
  token.text = std::string(word);
  for (std::size_t i = 0; i < word.size(); ++i) advance();
  return token;
}

std::string Lexer::take_lines_to(char first) {
  const std::size_t begin = offset_;
  while (offset_ < text_.size() && (position_.column != 1 || text_[offset_] != first)) advance();
  return std::string(text_.substr(begin, offset_ - begin));
}

bool Lexer::take_block(std::string& block) {
  constexpr std::string_view terminator = "END";
  for (std::size_t at = text_.find(terminator, offset_); at != std::string_view::npos;
       at = text_.find(terminator, at + 1)) {
    const std::size_t end = at + terminator.size();
    if (at > 0 && is_identifier_part(text_[at - 1])) continue;
    if (end < text_.size() && is_identifier_part(text_[end])) continue;
    block = std::string(text_.substr(offset_, at - offset_));
    while (offset_ < end) advance();
    return true;
  }
  return false;
}

}  // namespace tandem::program::amber
