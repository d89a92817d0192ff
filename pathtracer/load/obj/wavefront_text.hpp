#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <istream>
#include <optional>
#include <span>
#include <streambuf>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "base/error.hpp"

namespace tandem::pathtracer {

/// The text of an OBJ or MTL file as tinyobjloader should see it, one statement a line.
///
/// tinyobjloader reads what is no number as 0, keeps spaces in some names and not in others, and knows no line numbers
/// in its callbacks. So each statement passes through a filter first, which checks it strictly; and because the text is
/// handed out line by line, line() is the line that tinyobjloader works on when it calls back.
class WavefrontText : private std::streambuf {
 public:
  /// Gets a statement without surrounding blanks and comment lines; returns what tinyobjloader is to read, "" for
  /// nothing.
  using Filter = std::function<std::string(std::string_view statement)>;

  /// Reads the file. Throws Error when that fails or it holds no text.
  WavefrontText(std::filesystem::path path, Filter filter);

  /// Throws what the filter throws while it is read from.
  std::istream& stream() { return stream_; }
  /// "file:line" of the statement that was handed out last.
  std::string place() const;
  std::size_t line() const noexcept { return line_; }
  /// "file:line: why", for the statement that was handed out last.
  Error error(std::string_view why) const;
  /// The same for a statement further up.
  Error error_at(std::size_t line, std::string_view why) const;
  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  int_type underflow() override;
  /// The next statement, with lines that end in a backslash joined; false at the end.
  bool next_statement(std::string& statement);

  std::filesystem::path path_;
  Filter filter_;
  std::string text_;
  std::size_t position_ = 0;
  std::size_t line_ = 0;       ///< of the statement handed out, from 1
  std::size_t next_line_ = 1;  ///< at position_
  std::string current_;
  std::istream stream_;
};

/// The first word of a statement, and the rest without blanks around it.
struct Statement {
  std::string_view keyword;
  std::string_view rest;
};
Statement split_statement(std::string_view statement);

/// The next word of `text`, which is shortened by it; "" at the end.
std::string_view take_word(std::string_view& text);

/// Whether `word` is a whole decimal number (or nan or inf), written as in C.
bool parse_number(std::string_view word, double& value);
bool parse_integer(std::string_view word, int& value);

/// "a, b, c, d and 5 more", as names are shown in sentences.
std::string abbreviated(std::span<const std::string> names);

/// The three numbers behind the coordinates of a vertex, as Blender and MeshLab write colours, encoded as sRGB in [0,
/// 1]. Returns the linear colour, or nothing where there are fewer.
std::optional<glm::vec3> parse_vertex_color(std::string_view rest);

}  // namespace tandem::pathtracer
