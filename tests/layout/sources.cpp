#include "tests/layout/sources.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace tandem::test {
namespace {

namespace fs = std::filesystem;

/// The file that a line includes with quotes; empty for any other line.
std::string_view included_in(std::string_view line) {
  constexpr std::string_view directive = "#include \"";
  if (!line.starts_with(directive)) return {};
  line.remove_prefix(directive.size());
  const std::size_t end = line.find('"');
  return end == std::string_view::npos ? std::string_view{} : line.substr(0, end);
}

Source read(const fs::path& root, const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  Source source{.path = path.lexically_relative(root).generic_string(), .includes = {}};
  for (std::string line; std::getline(file, line); ++source.lines) {
    const std::string_view included = included_in(line);
    if (included.empty()) continue;
    // What is in neither place is generated, or GLSL within a test.
    for (const fs::path& place : {root / included, path.parent_path() / included}) {
      if (!fs::exists(place)) continue;
      source.includes.push_back(place.lexically_normal().lexically_relative(root).generic_string());
      break;
    }
  }
  return source;
}

/// All that `from` leads to, itself only by a circle.
std::set<std::string> reached(const Graph& graph, const std::string& from) {
  std::set<std::string> found;
  std::vector<std::string> open = {from};
  while (!open.empty()) {
    const auto edges = graph.find(open.back());
    open.pop_back();
    if (edges == graph.end()) continue;
    for (const std::string& next : edges->second)
      if (found.insert(next).second) open.push_back(next);
  }
  return found;
}

}  // namespace

std::vector<Source> repository_sources() {
  const fs::path root = fs::path(TANDEM_SOURCE_DIRECTORY).lexically_normal();
  std::vector<Source> sources;
  for (const fs::directory_entry& top : fs::directory_iterator(root)) {
    const std::string name = top.path().filename().string();
    if (!top.is_directory() || name.starts_with(".") || name.starts_with("build")) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(top)) {
      const fs::path extension = entry.path().extension();
      if (entry.is_regular_file() && (extension == ".hpp" || extension == ".cpp"))
        sources.push_back(read(root, entry.path()));
    }
  }
  std::ranges::sort(sources, {}, &Source::path);
  return sources;
}

std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/')); }
std::string top_folder_of(const std::string& path) { return path.substr(0, path.find('/')); }
std::string noun_of(const std::string& path) { return path.substr(0, path.rfind('.')); }

Graph include_graph(const std::vector<Source>& sources, std::string (*name)(const std::string& path)) {
  Graph graph;
  for (const Source& source : sources)
    for (const std::string& included : source.includes)
      if (std::string to = name(included); to != name(source.path)) graph[name(source.path)].insert(std::move(to));
  return graph;
}

std::vector<std::set<std::string>> circles(const Graph& graph) {
  std::map<std::string, std::set<std::string>> reaches;
  for (const auto& [from, edges] : graph) reaches.emplace(from, reached(graph, from));
  std::vector<std::set<std::string>> found;
  std::set<std::string> done;
  for (const auto& [from, targets] : reaches) {
    if (!targets.contains(from) || done.contains(from)) continue;
    std::set<std::string>& circle = found.emplace_back();
    for (const std::string& target : targets)
      if (const auto back = reaches.find(target); back != reaches.end() && back->second.contains(from))
        circle.insert(target);
    done.insert(circle.begin(), circle.end());
  }
  return found;
}

}  // namespace tandem::test
