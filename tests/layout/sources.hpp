#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

/// The C++ files of the repository, and what they include.
namespace tandem::test {

struct Source {
  std::string path;                   ///< from the root of the repository: "compare/cause/tie.hpp"
  std::vector<std::string> includes;  ///< files of the repository only, as paths likewise
  std::size_t lines = 0;
};

/// All .hpp and .cpp files but those of builds and hidden folders, by path. Throws for a file that cannot be read.
std::vector<Source> repository_sources();

/// "compare/cause" of "compare/cause/tie.hpp".
std::string folder_of(const std::string& path);
/// "compare" likewise.
std::string top_folder_of(const std::string& path);
/// "compare/cause/tie" likewise: a header and its source are one noun.
std::string noun_of(const std::string& path);

/// What names name.
using Graph = std::map<std::string, std::set<std::string>>;

/// The includes between what `name` makes of the paths of files, those within one name left out.
Graph include_graph(const std::vector<Source>& sources, std::string (*name)(const std::string& path));

/// Sets of names each of which leads to all others of its set; by their first names.
std::vector<std::set<std::string>> circles(const Graph& graph);

}  // namespace tandem::test
