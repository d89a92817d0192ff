#include "program/data/table.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include <fmt/format.h>

#include "base/text_file.hpp"
#include "program/data/scalar.hpp"

namespace tandem::program {
namespace {

using Row = std::vector<std::string>;

constexpr std::size_t all_lines = std::numeric_limits<std::size_t>::max();

bool is_separator(char c) { return c == ',' || c == ';' || c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool is_number(std::string_view word) {
  if (word.empty()) return false;
  const std::string_view digits = word.front() == '-' || word.front() == '+' ? word.substr(1) : word;
  return !digits.empty() &&
         ((digits[0] >= '0' && digits[0] <= '9') || digits[0] == '.' || digits == "nan" || digits == "inf");
}

/// The array that a table has a line for each element of; null if the value is none.
const ValueType* tabular(const ValueType& type) { return type.kind == ValueType::Kind::array ? &type : nullptr; }

/// A header and at most `lines` lines of values.
std::vector<Row> rows_of(const ValueType& type, std::span<const std::byte> bytes, std::size_t lines) {
  std::vector<Row> rows;
  const std::uint64_t count = scalar_count(type, bytes.size());
  const ValueType* array = tabular(type);
  if (array == nullptr) {
    rows.push_back({"name", "value"});
    for (std::uint64_t i = 0; i < count && i < lines; ++i) {
      const Place place = place_of(type, bytes.size(), i);
      const std::string path = path_of(type, bytes.size(), i);
      rows.push_back({path.empty() ? "value" : path, to_text(place.scalar, bits_at(bytes, place))});
    }
    return rows;
  }
  const ValueType& element = array->element.front();
  const std::uint64_t columns = scalar_count(element, element.size);
  rows.emplace_back();
  for (std::uint64_t i = 0; i < columns; ++i) {
    const std::string path = path_of(element, element.size, i);
    rows.back().push_back(path.empty() ? "value" : path.starts_with('.') ? path.substr(1) : path);
  }
  if (columns == 0) return rows;
  for (std::uint64_t line = 0; line < count / columns && line < lines; ++line) {
    rows.emplace_back();
    for_each_place(
        element, element.size,
        [&](const Place& place) { rows.back().push_back(to_text(place.scalar, bits_at(bytes, place))); },
        line * array->stride);
  }
  return rows;
}

}  // namespace

std::vector<std::string> value_words(std::string_view text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text) {
    if (!is_separator(c)) {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::move(word));
      word.clear();
    }
  }
  if (!word.empty()) words.push_back(std::move(word));
  return words;
}

std::vector<std::string> read_table(const std::filesystem::path& path) {
  std::istringstream text(read_text(path));
  std::vector<std::string> values;
  std::string line;
  bool is_first = true, has_names = false;
  while (std::getline(text, line)) {
    const std::vector<std::string> words = value_words(line);
    if (words.empty()) continue;
    if (is_first) {
      is_first = false;
      has_names = words.size() == 2 && words[0] == "name" && words[1] == "value";
      if (!is_number(words[0]) || has_names) continue;
    }
    values.insert(values.end(), words.begin() + (has_names && words.size() > 1 ? 1 : 0), words.end());
  }
  return values;
}

std::string to_csv(const ValueType& type, std::span<const std::byte> bytes) {
  std::string text;
  for (const Row& row : rows_of(type, bytes, all_lines)) text += fmt::format("{}\n", fmt::join(row, ","));
  return text;
}

std::string to_columns(const ValueType& type, std::span<const std::byte> bytes, std::size_t lines) {
  std::vector<Row> rows = rows_of(type, bytes, lines);
  if (tabular(type) != nullptr)
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i].insert(rows[i].begin(), i == 0 ? "" : fmt::format("[{}]", i - 1));
  std::vector<std::size_t> widths(rows.front().size());
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (const Row& row : rows) {
    text += " ";
    for (std::size_t i = 0; i < row.size(); ++i)
      text += i == 0 ? fmt::format(" {:<{}}", row[i], widths[i]) : fmt::format("  {:>{}}", row[i], widths[i]);
    text += "\n";
  }
  return text;
}

}  // namespace tandem::program
