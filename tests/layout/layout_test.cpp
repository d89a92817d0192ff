// Where files lie and what they may include: docs/architecture.md as a test.

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/layout/sources.hpp"

namespace tandem::test {
namespace {

using Circle = std::set<std::string>;

/// Circles that are there, each with the reason.
struct KnownCircle {
  Circle names;
  const char* reason;
};

const std::vector<KnownCircle> known_circles_of_folders = {
    {{"tests/shaders", "tests/support/statistics"},
     "the test of chi_square draws with the random source of the shaders"},
};

/// Between nouns: a header together with its source.
const std::vector<KnownCircle> known_circles_of_nouns = {
    {{"pathtracer/load/obj/mtl_loader", "pathtracer/load/obj/mtl_material"},
     "the loader's header declares the material that both give"},
    {{"pathtracer/scene/environment", "pathtracer/scene/lights"},
     "the environment is a light, and its power is measured as that of lights is"},
    {{"rhi_cpu/ray_launch", "rhi_cpu/trace_ray"}, "a launch runs shaders, which trace rays of the same launch"},
    {{"rhi_cpu/trace/embree/candidates", "rhi_cpu/trace/embree/vertex_hit"},
     "a ray that meets nothing is traced once more, by the same search"},
    {{"rhi_vulkan/compute_pipeline", "rhi_vulkan/pipeline_layout", "rhi_vulkan/ray_tracing_pipeline"},
     "the layout of a pipeline handle is found by the pipeline's kind"},
};

/// What each folder at the top may include besides itself.
const std::map<std::string, std::set<std::string>> allowed = {
    {"base", {}},
    {"rhi", {"base"}},
    {"rhi_cpu", {"base", "rhi"}},
    {"rhi_vulkan", {"base", "rhi"}},
    {"devices", {"base", "rhi", "rhi_cpu", "rhi_vulkan"}},
    {"pathtracer", {"base", "rhi"}},
    {"compare", {"base", "rhi", "pathtracer"}},
    {"conformance", {"base", "rhi"}},
    {"program", {"base", "rhi"}},
    {"tools", {"base", "rhi", "devices", "pathtracer", "compare", "conformance", "program"}},
};

/// Folders that show code and tests, which may include anything.
const std::set<std::string> unordered = {"docs", "examples", "tests"};

constexpr std::size_t most_files = 40;
const std::map<std::string, const char*> large_folders = {
    {"rhi_vulkan", "a header and a source for each noun of rhi"},
};

constexpr std::size_t most_lines = 400;

const std::vector<Source>& sources() {
  static const std::vector<Source> all = repository_sources();
  return all;
}

std::string text(const Circle& circle) {
  std::string names;
  for (const std::string& name : circle) names += (names.empty() ? "" : ", ") + name;
  return names;
}

/// The includes that make a circle.
std::string includes_in(const Circle& circle, std::string (*name)(const std::string& path)) {
  std::string lines;
  for (const Source& source : sources())
    for (const std::string& included : source.includes)
      if (name(source.path) != name(included) && circle.contains(name(source.path)) && circle.contains(name(included)))
        lines += "\n  " + source.path + " includes " + included;
  return lines;
}

void check_circles(std::string (*name)(const std::string& path), const std::vector<KnownCircle>& known) {
  const std::vector<Circle> found = circles(include_graph(sources(), name));
  for (const Circle& circle : found) {
    const bool is_known =
        std::ranges::any_of(known, [&](const KnownCircle& each) { return std::ranges::includes(each.names, circle); });
    CHECK_MESSAGE(is_known, "a circle: ", text(circle), includes_in(circle, name));
  }
  for (const KnownCircle& each : known) {
    const bool is_there =
        std::ranges::any_of(found, [&](const Circle& circle) { return std::ranges::includes(each.names, circle); });
    WARN_MESSAGE(is_there, "no circle any more, strike it from the list: ", text(each.names));
  }
}

std::string itself(const std::string& path) { return path; }

TEST_CASE("circles are found") {
  CHECK(circles({{"a", {"b"}}, {"b", {"c"}}}).empty());
  CHECK(circles({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b", "d"}}, {"d", {}}}) == std::vector<Circle>{{"b", "c"}});
  CHECK(circles({{"a", {"a"}}}) == std::vector<Circle>{{"a"}});
  CHECK(circles({{"a", {"b"}}, {"b", {"a", "c"}}, {"c", {"d"}}, {"d", {"c"}}}) ==
        std::vector<Circle>{{"a", "b"}, {"c", "d"}});
}

TEST_CASE("the repository is read") {
  const auto named = [](const char* path) {
    const auto found = std::ranges::find(sources(), path, &Source::path);
    REQUIRE(found != sources().end());
    return *found;
  };
  CHECK(sources().size() > 600);
  const Source tie = named("compare/cause/tie.hpp");
  CHECK(std::ranges::count(tie.includes, "compare/cause/difference_class.hpp") == 1);
  CHECK(tie.lines > 20);
  CHECK(folder_of(tie.path) == "compare/cause");
  CHECK(top_folder_of(tie.path) == "compare");
  CHECK(noun_of(tie.path) == "compare/cause/tie");
}

TEST_CASE("no file includes itself by way of others") { check_circles(itself, {}); }

TEST_CASE("no header with its source includes itself by way of others") {
  check_circles(noun_of, known_circles_of_nouns);
}

TEST_CASE("no folder includes itself by way of others") { check_circles(folder_of, known_circles_of_folders); }

TEST_CASE("folders include only what is below them") {
  for (const Source& source : sources()) {
    const std::string from = top_folder_of(source.path);
    if (unordered.contains(from)) continue;
    const auto rule = allowed.find(from);
    REQUIRE_MESSAGE(rule != allowed.end(), from, " has no place in the order of folders: ", source.path);
    for (const std::string& included : source.includes) {
      const std::string to = top_folder_of(included);
      const bool is_allowed = to == from || rule->second.contains(to);
      CHECK_MESSAGE(is_allowed, source.path, " includes ", included);
    }
  }
}

TEST_CASE("a folder has no more files than can be looked over") {
  std::map<std::string, std::size_t> counts;
  for (const Source& source : sources()) ++counts[folder_of(source.path)];
  for (const auto& [folder, count] : counts) {
    const bool is_small = count <= most_files || large_folders.contains(folder);
    CHECK_MESSAGE(is_small, folder, " has ", count, " files");
  }
}

TEST_CASE("a file is no longer than can be read at once") {
  for (const Source& source : sources())
    CHECK_MESSAGE(source.lines <= most_lines, source.path, " has ", source.lines, " lines");
}

}  // namespace
}  // namespace tandem::test
