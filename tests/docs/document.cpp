#include "tests/docs/document.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <stdexcept>

namespace tandem::test {
namespace {

namespace fs = std::filesystem;

const fs::path source_directory = TANDEM_SOURCE_DIRECTORY;

Document read(const fs::path& path) {
  Document document{.path = path, .lines = {}};
  std::ifstream file(source_directory / path);
  bool fenced = false, after_blank = true, in_code = false;
  std::size_t number = 0;
  for (std::string text; std::getline(file, text);) {
    const bool fence = text.starts_with("```");
    const bool blank = text.find_first_not_of(' ') == std::string::npos;
    // Four spaces begin code behind an empty line, else they continue an item of a list.
    in_code = !blank && text.starts_with("    ") && (after_blank || in_code);
    LineKind kind = LineKind::prose;
    if (fence || fenced || in_code)
      kind = LineKind::code;
    else if (text.starts_with('#'))
      kind = LineKind::heading;
    else if (text.starts_with('|'))
      kind = LineKind::table;
    if (fence) fenced = !fenced;
    after_blank = blank;
    document.lines.push_back({.number = ++number, .kind = kind, .text = std::move(text)});
  }
  return document;
}

/// The first group of every match of the pattern, in lines for which `wanted` holds.
template <typename Wanted>
std::vector<Span> matches(const Document& document, const std::regex& pattern, Wanted&& wanted) {
  std::vector<Span> found;
  for (const Line& line : document.lines) {
    if (!wanted(line)) continue;
    for (std::sregex_iterator match(line.text.begin(), line.text.end(), pattern), end; match != end; ++match)
      found.push_back({.line = line.number, .text = (*match)[1].str()});
  }
  return found;
}

bool is_no_code(const Line& line) { return line.kind != LineKind::code; }

}  // namespace

std::string Document::text() const {
  std::string result;
  for (const Line& line : lines) result += line.text + "\n";
  return result;
}

std::vector<std::string> Document::anchors() const {
  std::vector<std::string> result;
  for (const Line& line : lines) {
    if (line.kind != LineKind::heading) continue;
    std::string anchor;
    for (const char letter : line.text.substr(std::min(line.text.find_first_not_of("# "), line.text.size()))) {
      const auto byte = static_cast<unsigned char>(letter);
      if (std::isalnum(byte) != 0 || letter == '-' || letter == '_')
        anchor += static_cast<char>(std::tolower(byte));
      else if (letter == ' ')
        anchor += '-';
    }
    result.push_back(std::move(anchor));
  }
  return result;
}

std::vector<Span> links(const Document& document) {
  static const std::regex link(R"(\]\(([^()\s]+)\))");
  return matches(document, link, is_no_code);
}

std::vector<Span> code_spans(const Document& document) {
  static const std::regex code("`([^`]+)`");
  return matches(document, code, is_no_code);
}

std::vector<Span> code_lines(const Document& document) {
  static const std::regex all("^(.+)$");
  return matches(document, all, [](const Line& line) { return line.kind == LineKind::code; });
}

const std::vector<Document>& documents() {
  static const std::vector<Document> all = [] {
    std::vector<fs::path> paths = {"README.md", "CONTRIBUTING.md", "CHANGELOG.md"};
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(source_directory / "docs"))
      if (entry.path().extension() == ".md") paths.push_back(fs::relative(entry.path(), source_directory));
    std::ranges::sort(paths);
    std::vector<Document> result;
    for (const fs::path& path : paths) result.push_back(read(path));
    return result;
  }();
  return all;
}

const Document& document(const fs::path& path) {
  const auto found = std::ranges::find(documents(), path, &Document::path);
  if (found == documents().end()) throw std::logic_error("no document " + path.string());
  return *found;
}

}  // namespace tandem::test
