// What the documents say of the repository: links, paths, commands, numbers. Most of it is wrong after a move of files
// and seen by nobody.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "tests/docs/document.hpp"

namespace tandem::test {
namespace {

namespace fs = std::filesystem;

const fs::path source_directory = TANDEM_SOURCE_DIRECTORY;

/// "docs/index.md:12".
std::string place(const Document& document, std::size_t line) {
  return document.path.string() + ":" + std::to_string(line);
}

/// Written by a program: long lines, which are not ours to wrap.
bool is_generated(const Document& document) {
  const std::set<std::string> generated = {"docs/results/backend-status.md", "docs/results/faults.md",
                                           "docs/results/gallery.md"};
  return generated.contains(document.path.generic_string());
}

/// Whether a file or folder of that name exists; a `*` stands for any part of the last name.
bool names_file(const fs::path& path) {
  const std::string name = path.filename().string();
  const std::size_t star = name.find('*');
  if (star == std::string::npos) return fs::exists(path);
  if (!fs::is_directory(path.parent_path())) return false;
  const std::string head = name.substr(0, star), tail = name.substr(star + 1);
  return std::ranges::any_of(fs::directory_iterator(path.parent_path()), [&](const fs::directory_entry& entry) {
    const std::string each = entry.path().filename().string();
    return each.size() >= head.size() + tail.size() && each.starts_with(head) && each.ends_with(tail);
  });
}

/// The number that the first group of the pattern matches, which must occur.
unsigned number_in(const Document& document, const std::string& pattern) {
  const std::string text = document.text();
  std::smatch match;
  const bool found = std::regex_search(text, match, std::regex(pattern));
  CAPTURE(document.path.string());
  CAPTURE(pattern);
  REQUIRE(found);
  return static_cast<unsigned>(std::stoul(match[1].str()));
}

/// Checks that wherever a document has the pattern, its first group is this number.
void check_everywhere(const std::string& pattern, unsigned number) {
  const std::regex regex(pattern);
  for (const Document& document : documents()) {
    if (is_generated(document)) continue;
    const std::string text = document.text();
    for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match) {
      CAPTURE(document.path.string());
      CAPTURE(match->str());
      CHECK((*match)[1].str() == std::to_string(number));
    }
  }
}

TEST_CASE("every link of a document leads to a file, and every anchor to a heading") {
  std::size_t checked = 0;
  for (const Document& each : documents()) {
    for (const Span& link : links(each)) {
      if (link.text.starts_with("http")) continue;
      CAPTURE(place(each, link.line));
      CAPTURE(link.text);
      const std::size_t hash = std::min(link.text.find('#'), link.text.size());
      const std::string file = link.text.substr(0, hash);
      const fs::path target = file.empty() ? each.path : (each.path.parent_path() / file).lexically_normal();
      CHECK(fs::exists(source_directory / target));
      ++checked;
      if (hash == link.text.size()) continue;
      const std::vector<std::string> anchors = document(target).anchors();
      CHECK(std::ranges::find(anchors, link.text.substr(hash + 1)) != anchors.end());
    }
  }
  CHECK(checked > 100);
}

TEST_CASE("every path of the repository that a document names exists") {
  const std::regex path(
      "^(?:base|cmake|compare|conformance|devices|docs|pathtracer|rhi|rhi_cpu|rhi_vulkan|scenes|"
      "scripts|shaders|tests|tools)/[A-Za-z0-9_./*-]*");
  std::size_t checked = 0;
  for (const Document& each : documents()) {
    if (each.path == "CHANGELOG.md") continue;  // of paths that were
    for (const Span& code : code_spans(each)) {
      std::smatch match;
      if (!std::regex_search(code.text, match, path)) continue;
      CAPTURE(place(each, code.line));
      CAPTURE(match.str());
      CHECK(names_file(source_directory / match.str()));
      ++checked;
    }
  }
  CHECK(checked > 100);
}

TEST_CASE("every command that a document names is a command") {
  const std::regex command(R"((?:^|build/|\$ |^ +)tandem ([a-z]+))");
  std::set<std::string> commands;
  for (const fs::directory_entry& entry : fs::directory_iterator(source_directory / "tools/command"))
    commands.insert(entry.path().stem().string());
  // Of other people's shaders, and commands below a command.
  for (const char* form : {"diff_program", "explain_program", "study_denoising", "study_markov", "study_metropolis"})
    commands.erase(form);
  std::set<std::string> named;
  for (const Document& each : documents()) {
    std::vector<Span> code = code_spans(each);
    for (const Span& line : code_lines(each)) code.push_back(line);
    for (const Span& span : code) {
      std::smatch match;
      if (!std::regex_search(span.text, match, command)) continue;
      CAPTURE(place(each, span.line));
      CAPTURE(match[1].str());
      CHECK(commands.contains(match[1].str()));
      named.insert(match[1].str());
    }
  }
  CHECK(named == commands);
}

TEST_CASE("docs/index.md links every document") {
  std::set<fs::path> linked = {"docs/index.md"};
  for (const Span& link : links(document("docs/index.md")))
    linked.insert(("docs" / fs::path(link.text)).lexically_normal());
  for (const Document& each : documents()) {
    CAPTURE(each.path.string());
    CHECK(linked.contains(each.path));
  }
}

TEST_CASE("the numbers of faults are everywhere those of docs/results/faults.md") {
  const Document& faults = document("docs/results/faults.md");
  const unsigned harmful = number_in(faults, R"(\d+ of (\d+) harmful faults)");
  const unsigned harmless = number_in(faults, R"(\d+ of (\d+) harmless faults)");
  const unsigned controls = number_in(faults, R"(\d+ of (\d+) unmodified controls)");
  std::size_t rows = 0;
  for (const Line& line : faults.lines) rows += line.kind == LineKind::table ? 1 : 0;
  CHECK(rows == harmful + harmless + controls + 2);
  const Document& readme = document("README.md");
  CHECK(number_in(readme, R"((\d+)\s+harmful)") == harmful);
  CHECK(number_in(readme, R"((\d+)\s+harmless)") == harmless);
  CHECK(number_in(readme, R"((\d+)\s+unmodified\s+controls)") == controls);
  check_everywhere(R"((\d+)\s+harmful)", harmful);
  check_everywhere(R"((\d+)\s+harmless)", harmless);
  check_everywhere(R"((\d+)\s+unmodified\s+controls)", controls);
}

TEST_CASE("the number of conformance cases is everywhere that of docs/results/backend-status.md") {
  const unsigned cases = number_in(document("docs/results/backend-status.md"), R"(## The (\d+) cases)");
  CHECK(number_in(document("README.md"), R"((\d+)\s+small\s+cases)") == cases);
  check_everywhere(R"((\d{3,})\s+(?:small\s+|conformance\s+)?cases)", cases);
}

TEST_CASE("the number of scenes of the gallery is everywhere that of docs/results/gallery.md") {
  std::size_t rows = 0;
  for (const Line& line : document("docs/results/gallery.md").lines)
    rows += line.kind == LineKind::table && line.text.find("images/gallery/") != std::string::npos ? 1 : 0;
  check_everywhere(R"((\d+)\s+scenes of the)", static_cast<unsigned>(rows));
}

TEST_CASE("prose is wrapped at 120 columns") {
  constexpr std::size_t columns = 120;
  for (const Document& each : documents()) {
    if (is_generated(each)) continue;
    for (const Line& line : each.lines) {
      if (line.kind != LineKind::prose || line.text.starts_with("![")) continue;
      CAPTURE(place(each, line.number));
      // Bytes that continue a character of UTF-8 take no column.
      const auto length =
          std::ranges::count_if(line.text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; });
      CHECK(static_cast<std::size_t>(length) <= columns);
    }
  }
}

}  // namespace
}  // namespace tandem::test
