#include "pathtracer/load/obj/wavefront_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/printable.hpp"
#include "base/srgb.hpp"
#include "base/text_file.hpp"

namespace tandem::pathtracer {
namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

template <typename Number>
bool parse_whole(std::string_view word, Number& value) {
  // from_chars takes no plus sign; "+-1" is still no number.
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

WavefrontText::WavefrontText(std::filesystem::path path, Filter filter)
    : path_(std::move(path)), filter_(std::move(filter)), text_(read_text(path_)), stream_(this) {
  // Otherwise the stream would swallow what the filter throws.
  stream_.exceptions(std::ios::badbit);
}

std::string WavefrontText::place() const { return fmt::format("{}:{}", path_.string(), line_); }

Error WavefrontText::error(std::string_view why) const { return error_at(line_, why); }

Error WavefrontText::error_at(std::size_t line, std::string_view why) const {
  return Error(fmt::format("{}:{}: {}", path_.string(), line, why));
}

bool WavefrontText::next_statement(std::string& statement) {
  statement.clear();
  if (position_ >= text_.size()) return false;
  line_ = next_line_;
  for (bool continued = true; continued && position_ < text_.size();) {
    const std::size_t end = std::min(text_.find_first_of("\r\n", position_), text_.size());
    std::string_view line = trimmed(std::string_view(text_).substr(position_, end - position_));
    position_ = end + (text_.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    ++next_line_;
    continued = line.ends_with('\\');
    if (continued) line.remove_suffix(1);
    statement += line;
    if (continued) statement += ' ';
  }
  return true;
}

WavefrontText::int_type WavefrontText::underflow() {
  std::string statement;
  while (next_statement(statement)) {
    const std::string_view content = trimmed(statement);
    if (content.empty() || content.starts_with('#')) continue;
    current_ = filter_(content);
    if (current_.empty()) continue;
    current_ += '\n';
    setg(current_.data(), current_.data(), current_.data() + current_.size());
    return traits_type::to_int_type(current_.front());
  }
  return traits_type::eof();
}

Statement split_statement(std::string_view statement) {
  Statement parts;
  parts.rest = statement;
  parts.keyword = take_word(parts.rest);
  parts.rest = trimmed(parts.rest);
  return parts;
}

std::string_view take_word(std::string_view& text) {
  const std::size_t first = std::min(text.find_first_not_of(blanks), text.size());
  const std::size_t end = std::min(text.find_first_of(blanks, first), text.size());
  const std::string_view word = text.substr(first, end - first);
  text.remove_prefix(end);
  return word;
}

bool parse_number(std::string_view word, double& value) {
  if (parse_whole(word, value)) return true;
  // Beyond the range of double, what remains is 0 or infinity.
  long double wide = 0;
  if (!parse_whole(word, wide)) return false;
  value = static_cast<double>(wide);
  return true;
}

bool parse_integer(std::string_view word, int& value) { return parse_whole(word, value); }

std::string abbreviated(std::span<const std::string> names) {
  constexpr std::size_t most = 4;
  std::vector<std::string> shown;
  for (const std::string& name : names.first(std::min(names.size(), most))) shown.push_back(shortened(name));
  const std::string more = names.size() > most ? fmt::format(" and {} more", names.size() - most) : std::string();
  return fmt::format("{}{}", fmt::join(shown, ", "), more);
}

std::optional<glm::vec3> parse_vertex_color(std::string_view rest) {
  glm::vec3 color(0);
  for (int channel = 0; channel < 3; ++channel) {
    double value = 0;
    if (!parse_number(take_word(rest), value) || !std::isfinite(value)) return std::nullopt;
    color[channel] = srgb_decode(static_cast<float>(std::clamp(value, 0.0, 1.0)));
  }
  return color;
}

}  // namespace tandem::pathtracer
