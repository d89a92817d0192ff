// docs/schema/scene.schema.json against the loader: what the one accepts the other does, for every way to spoil a
// description by a single change.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "pathtracer/image/image_io.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "tests/pathtracer/load/description/json_schema.hpp"
#include "tests/support/run_summary.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using Json = nlohmann::json;

namespace {

const std::filesystem::path source_directory = TANDEM_SOURCE_DIRECTORY;

Json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  return Json::parse(file);
}

const test::JsonSchema& schema() {
  static const test::JsonSchema schema(read_json(source_directory / "docs" / "schema" / "scene.schema.json"));
  return schema;
}

/// A folder with the files that complete.json names.
class Sandbox {
 public:
  Sandbox() {
    folder_.write("model.obj", "mtllib model.mtl\nusemtl grey\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder_.write("model.mtl", "newmtl grey\n");
    pathtracer::write_image(folder_.path() / "picture.png",
                            {.width = 2, .height = 1, .pixels = {glm::vec3(0.25f), glm::vec3(0.5f)}}, {});
  }
  /// What the loader says against the description; empty: nothing.
  std::string error(const Json& description) const {
    try {
      pathtracer::load_scene(folder_.write("scene.json", description.dump()));
      return {};
    } catch (const tandem::Error& error) {
      return error.what();
    }
  }
  std::string file() const { return (folder_.path() / "scene.json").string(); }

 private:
  test::ScratchFolder folder_;
};

/// complete.json, and the cameras that it has no place for.
std::vector<Json> documents() {
  std::vector<Json> result = {read_json(source_directory / "tests/pathtracer/load/description/complete.json")};
  const Json camera = {
      {"position", {11, 12, 13}}, {"target", {4, 5, 7.5}}, {"up", {0.25, 1.5, 0.1}}, {"motion", {0.1, 0.2, 0.3}}};
  for (const char* type : {"orthographic", "equirectangular"}) {
    Json document = {{"models", {{{"file", "model.obj"}}}}, {"camera", camera}};
    document["materials"]["plain"] = {{"model", "diffuse"}};
    document["quads"] = {{{"corner", {1, 2, 3}}, {"u", {4, 5, 6}}, {"v", {7, -8, 9}}, {"material", "plain"}}};
    document["camera"]["type"] = type;
    if (document["camera"]["type"] == "orthographic") document["camera"]["view_height"] = 2.5;
    result.push_back(document);
  }
  return result;
}

/// Where a value stands, what the schema says of it, and what it is called in messages.
struct Place {
  Json::json_pointer pointer;
  const Json* schema;
  std::string name;
};

void collect(const Json& rule, const Json& value, const Json::json_pointer& pointer, const std::string& name,
             std::vector<Place>& places) {
  const Json& resolved = schema().resolve(rule, value);
  places.push_back({pointer, &resolved, name});
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i) {
      const bool listed = resolved.contains("prefixItems");
      collect(listed ? resolved["prefixItems"][i] : resolved["items"], value[i], pointer / i,
              fmt::format("{}[{}]", name, i), places);
    }
  if (value.is_object())
    for (const auto& [key, member] : value.items()) {
      const bool fixed = resolved.contains("properties");
      collect(fixed ? resolved["properties"][key] : resolved["additionalProperties"], member, pointer / key,
              name.empty() ? key : name + "." + key, places);
    }
}

std::vector<Place> places_of(const Json& document) {
  std::vector<Place> places;
  collect(schema().root(), document, Json::json_pointer(), "", places);
  return places;
}

bool has_free_names(const Json& rule) { return rule.contains("additionalProperties") && !rule.contains("properties"); }

/// The schema and the loader agree on the document. Returns whether they accept it.
bool check_agreement(const Sandbox& sandbox, const Json& document, const std::string& change) {
  const bool accepted = schema().accepts(document);
  const std::string error = sandbox.error(document);
  CAPTURE(change);
  CAPTURE(error);
  CHECK(accepted == error.empty());
  if (!error.empty()) CHECK(error.starts_with(sandbox.file() + ": "));
  return accepted;
}

}  // namespace

TEST_CASE("The schema and the loader accept the complete description") {
  const Sandbox sandbox;
  for (const Json& document : documents()) CHECK(check_agreement(sandbox, document, "none"));
}

TEST_CASE("The complete description says everything that the schema knows") {
  std::set<const Json*> visited;
  for (const Json& document : documents())
    for (const Place& place : places_of(document))
      if (place.schema->contains("properties"))
        for (const auto& [key, member] : document[place.pointer].items())
          visited.insert(&(*place.schema)["properties"][key]);
  const auto check_all_visited = [&](const Json& rule, const std::string& name) {
    if (!rule.contains("properties")) return;
    for (const auto& [key, property] : rule["properties"].items()) {
      CAPTURE(name);
      CAPTURE(key);
      CHECK(visited.contains(&property));
    }
  };
  check_all_visited(schema().root(), "root");
  for (const auto& [name, definition] : schema().root()["$defs"].items()) check_all_visited(definition, name);
}

TEST_CASE("The schema and the loader know the same members") {
  const Sandbox sandbox;
  for (const Json& document : documents())
    for (const Place& place : places_of(document)) {
      if (!place.schema->contains("properties")) continue;
      Json changed = document;
      changed[place.pointer]["teapot"] = 1;
      CAPTURE(place.name);
      CHECK_FALSE(schema().accepts(changed));
      const std::string error = sandbox.error(changed);
      std::vector<std::string> known;
      const std::string mark = " is not known; known here are: ";
      const std::size_t at = error.find(mark);
      REQUIRE_MESSAGE(at != std::string::npos, error);
      CHECK(error.substr(0, at) == sandbox.file() + ": " + (place.name.empty() ? "" : place.name + ".") + "teapot");
      for (std::string rest = error.substr(at + mark.size()); !rest.empty();) {
        const std::size_t end = std::min(rest.find(", "), rest.size());
        known.push_back(rest.substr(0, end));
        rest.erase(0, std::min(end + 2, rest.size()));
      }
      std::vector<std::string> specified;
      for (const auto& [key, property] : (*place.schema)["properties"].items()) specified.push_back(key);
      std::ranges::sort(known);
      CHECK(fmt::format("{}", fmt::join(known, " ")) == fmt::format("{}", fmt::join(specified, " ")));
    }
}

TEST_CASE("The schema and the loader agree on descriptions with a wrong value") {
  const Sandbox sandbox;
  const std::vector<Json> values = {true, -1, 0, 2, 1e13, "teapot", Json::array(), Json::object()};
  int accepted = 0, refused = 0;
  for (const Json& document : documents())
    for (const Place& place : places_of(document)) {
      if (place.pointer.empty()) continue;
      for (const Json& value : values) {
        Json changed = document;
        Json& target = changed[place.pointer];
        const bool is_name_or_text = value.is_string() && schema().accepts(*place.schema, value);
        // Whether names stand for something is beyond a schema.
        if (is_name_or_text || (has_free_names(*place.schema) && value == Json::object())) continue;
        const bool number_for_number = value.is_number() && target.is_number();
        target = value;
        // A colour, say, may also be the name of a texture.
        if (value.is_string() && schema().accepts(changed)) continue;
        const bool agree_to_accept =
            check_agreement(sandbox, changed, fmt::format("{} = {}", place.name, value.dump()));
        (agree_to_accept ? accepted : refused) += 1;
        if (number_for_number && !agree_to_accept) {
          const std::string error = sandbox.error(changed);
          const std::string path = error.substr(0, error.find(" must ")).substr(sandbox.file().size() + 2);
          CHECK_MESSAGE(place.name.starts_with(path), place.name << " = " << value.dump() << ": " << error);
        }
      }
    }
  CHECK(accepted > 200);
  CHECK(refused > 1500);
}

TEST_CASE("The schema and the loader agree on which members are required") {
  const Sandbox sandbox;
  int accepted = 0, refused = 0;
  for (const Json& document : documents())
    for (const Place& place : places_of(document)) {
      if (!place.schema->contains("properties")) continue;
      for (const auto& [key, member] : document[place.pointer].items()) {
        // What other members name cannot be taken away.
        if (place.pointer.empty() && (key == "materials" || key == "textures" || key == "media")) continue;
        Json changed = document;
        changed[place.pointer].erase(key);
        (check_agreement(sandbox, changed, place.name + " without " + key) ? accepted : refused) += 1;
      }
    }
  CHECK(accepted > 100);
  CHECK(refused > 40);
}

TEST_CASE("The schema and the loader accept the scenes that ship, without a warning") {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_directory / "scenes")) {
    if (entry.path().extension() != ".json" || entry.path().stem() == "gallery" || entry.path().stem() == "suite" ||
        entry.path().stem().extension() == ".thresholds")
      continue;
    CAPTURE(entry.path().string());
    CHECK(schema().accepts(read_json(entry.path())));
    const pathtracer::Scene scene = pathtracer::load_scene(entry.path());
    CHECK(scene.camera.has_value());
    for (const std::string& warning : scene.warnings) FAIL_CHECK(warning);
    ++count;
  }
  CHECK(count >= 19);
}

TEST_CASE("Descriptions of the thesis's own files load") {
  const std::filesystem::path folder = source_directory.parent_path() / "shared" / "scenes" / "thesis";
  if (!std::filesystem::is_directory(folder)) TANDEM_SKIP(folder.string() + " is not there");
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_directory / "scenes" / "thesis")) {
    CAPTURE(entry.path().string());
    CHECK(schema().accepts(read_json(entry.path())));
    // The images of the medieval building are not among the files.
    CHECK_FALSE(pathtracer::load_scene(entry.path(), {.allow_missing_mtl = true, .allow_outside_files = true})
                    .triangles.empty());
    ++count;
  }
  CHECK(count == 14);
}
