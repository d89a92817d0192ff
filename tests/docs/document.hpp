#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// The Markdown documents of the repository, read as far as the tests need.
namespace tandem::test {

enum class LineKind {
  prose,  ///< running text or an item of a list
  table,  ///< a row
  heading,
  code  ///< fenced or indented
};

struct Line {
  std::size_t number = 0;  ///< from 1
  LineKind kind = LineKind::prose;
  std::string text;
};

struct Document {
  std::filesystem::path path;  ///< relative to the repository
  std::vector<Line> lines;

  std::string text() const;
  /// The anchors of its headings, as GitHub makes them: "the-rays" of "## The rays".
  std::vector<std::string> anchors() const;
};

/// Part of a document, with the line that it is on.
struct Span {
  std::size_t line = 0;
  std::string text;
};

/// Targets of links and images outside of code, with their anchors.
std::vector<Span> links(const Document& document);

/// Code between backticks outside of code blocks.
std::vector<Span> code_spans(const Document& document);

/// All lines of code blocks.
std::vector<Span> code_lines(const Document& document);

/// README.md, CONTRIBUTING.md, CHANGELOG.md and every .md file below docs/, in the order of their paths.
const std::vector<Document>& documents();

/// Throws std::logic_error when there is none of that path.
const Document& document(const std::filesystem::path& path);

}  // namespace tandem::test
