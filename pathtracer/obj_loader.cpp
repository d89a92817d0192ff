#include "pathtracer/obj_loader.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tiny_obj_loader.h>
#include <glm/geometric.hpp>

#include "pathtracer/mtl_loader.hpp"
#include "pathtracer/polygon.hpp"
#include "pathtracer/wavefront_text.hpp"

namespace tandem::pathtracer {
namespace {

constexpr std::uint32_t no_normal = std::numeric_limits<std::uint32_t>::max();
/// Of a triangle before the first usemtl, until the end of the file.
constexpr std::uint32_t no_material = triangle_smooth - 1;
constexpr glm::vec3 grey{0.5f};
/// Where a ray meets a triangle is found from products of three coordinates, which must be floats.
constexpr double largest_coordinate = 1e12;

/// A triangle whose positions and normals are still numbered as in the file, from 0.
struct FileTriangle {
  std::array<std::uint32_t, 3> positions;
  std::array<std::uint32_t, 3> normals;  ///< no_normal where there is none
  std::uint32_t material;
};

/// What the file has said so far.
struct Reading {
  WavefrontText* text = nullptr;
  ObjOptions options;
  Scene scene;  ///< its name, materials and warnings
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<FileTriangle> triangles;
  std::map<std::string, std::uint32_t, std::less<>> material_names;
  std::uint32_t current_material = no_material;
  std::optional<std::uint32_t> default_material;
  std::set<std::string> libraries;
  std::set<std::string> unknown_materials;
  std::set<std::string> ignored;  ///< keywords of elements that are no surfaces this loader knows
};

std::uint32_t add_material(Reading& reading, const std::string& name, const GpuMaterial& material) {
  reading.scene.materials.push_back(material);
  reading.scene.material_names.push_back(name);
  return static_cast<std::uint32_t>(reading.scene.materials.size() - 1);
}

std::uint32_t default_material(Reading& reading) {
  if (!reading.default_material) reading.default_material = add_material(reading, "default", diffuse_material(grey));
  return *reading.default_material;
}

void load_library(Reading& reading, const std::string& name) {
  if (!reading.libraries.insert(name).second) return;
  const std::filesystem::path path = reading.text->path().parent_path() / name;
  std::error_code status_error;
  if (!std::filesystem::exists(path, status_error)) {
    const std::string sentence = fmt::format("the material file '{}' does not exist", path.string());
    if (!reading.options.allow_missing_mtl) throw reading.text->error(sentence);
    reading.scene.warnings.push_back(reading.text->error(sentence).what());
    return;
  }
  for (const NamedMaterial& entry : load_mtl(path, reading.scene.warnings))
    if (!reading.material_names.contains(entry.name))
      reading.material_names.emplace(entry.name, add_material(reading, entry.name, entry.material));
}

/// `names` is one file name, or several without blanks.
void load_libraries(Reading& reading, std::string_view names) {
  if (names.empty()) throw reading.text->error("mtllib names no file");
  std::error_code status_error;
  if (std::filesystem::exists(reading.text->path().parent_path() / names, status_error))
    return load_library(reading, std::string(names));
  for (std::string_view name = take_word(names); !name.empty(); name = take_word(names))
    load_library(reading, std::string(name));
}

void use_material(Reading& reading, std::string_view name) {
  const auto known = reading.material_names.find(name);
  if (known != reading.material_names.end()) {
    reading.current_material = known->second;
    return;
  }
  reading.unknown_materials.emplace(name);
  reading.current_material = default_material(reading);
}

void check_position(const Reading& reading, const Statement& statement) {
  std::string_view rest = statement.rest;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view word = take_word(rest);
    double value = 0;
    if (word.empty()) throw reading.text->error("a vertex has fewer than three coordinates");
    if (!parse_number(word, value) || !std::isfinite(static_cast<float>(value)))
      throw reading.text->error(fmt::format("the vertex coordinate '{}' is no finite number", word));
    if (std::abs(value) > largest_coordinate)
      throw reading.text->error(fmt::format("the vertex coordinate '{}' is beyond {:g}, the farthest that rays reach",
                                            word, largest_coordinate));
  }
}

/// Each corner is "v", "v/vt", "v//vn" or "v/vt/vn". Returns the statement without a comment behind it.
std::string checked_face(const Reading& reading, std::string_view text) {
  text = text.substr(0, text.find('#'));
  std::string_view rest = split_statement(text).rest;
  for (std::string_view corner = take_word(rest); !corner.empty(); corner = take_word(rest)) {
    const std::string_view word = corner;
    for (int part = 0;; ++part) {
      const std::size_t slash = std::min(corner.find('/'), corner.size());
      const std::string_view index = corner.substr(0, slash);
      const bool may_be_empty = part == 1 && slash < corner.size();
      int value = 0;
      if (part > 2 || (!(index.empty() && may_be_empty) && (!parse_integer(index, value) || value == 0)))
        throw reading.text->error(fmt::format("'{}' is no corner of a face", word));
      if (slash == corner.size()) break;
      corner.remove_prefix(slash + 1);
    }
  }
  return std::string(text);
}

std::string filter(Reading& reading, std::string_view text) {
  const Statement statement = split_statement(text);
  if (statement.keyword == "v") {
    check_position(reading, statement);
    return std::string(text);
  }
  if (statement.keyword == "vn") return std::string(text);
  if (statement.keyword == "f") return checked_face(reading, text);
  if (statement.keyword == "usemtl") use_material(reading, statement.rest);
  if (statement.keyword == "mtllib") load_libraries(reading, statement.rest);
  for (const std::string_view element : {"p", "l", "curv", "curv2", "surf"})
    if (statement.keyword == element) reading.ignored.emplace(element);
  return {};
}

std::uint32_t resolve(const Reading& reading, int index, std::size_t count, std::string_view what) {
  const std::int64_t resolved = index > 0 ? std::int64_t{index} - 1 : std::int64_t(count) + index;
  if (resolved < 0 || resolved >= std::int64_t(count))
    throw reading.text->error(fmt::format("the {} index {} is out of range: there are {} so far", what, index, count));
  return static_cast<std::uint32_t>(resolved);
}

void add_face(Reading& reading, std::span<const tinyobj::index_t> corners) {
  if (corners.size() < 3) throw reading.text->error("a face has fewer than three corners");
  std::vector<std::uint32_t> positions, normals;
  std::vector<glm::vec3> polygon;
  for (const tinyobj::index_t& corner : corners) {
    positions.push_back(resolve(reading, corner.vertex_index, reading.positions.size(), "vertex"));
    normals.push_back(
        corner.normal_index == 0 ? no_normal : resolve(reading, corner.normal_index, reading.normals.size(), "normal"));
    polygon.push_back(reading.positions[positions.back()]);
  }
  for (const auto& [a, b, c] : triangulate(polygon))
    reading.triangles.push_back(
        {{positions[a], positions[b], positions[c]}, {normals[a], normals[b], normals[c]}, reading.current_material});
}

void parse(Reading& reading) {
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = [](void* data, float x, float y, float z, float) {
    Reading& reading = *static_cast<Reading*>(data);
    // tinyobjloader loses count where a number has hundreds of digits.
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z))
      throw reading.text->error("a vertex coordinate has too many digits");
    reading.positions.emplace_back(x, y, z);
  };
  callbacks.normal_cb = [](void* data, float x, float y, float z) {
    static_cast<Reading*>(data)->normals.emplace_back(x, y, z);
  };
  callbacks.index_cb = [](void* data, tinyobj::index_t* corners, int count) {
    add_face(*static_cast<Reading*>(data), {corners, static_cast<std::size_t>(count)});
  };
  std::string warning, error;
  tinyobj::LoadObjWithCallback(reading.text->stream(), callbacks, &reading, nullptr, &warning, &error);
  if (!error.empty()) throw Error(fmt::format("{}: {}", reading.text->path().string(), error));
}

/// Triangles before the first usemtl have the material of a library that defines just one, as some exporters mean it;
/// else the grey one.
void assign_materials(Reading& reading) {
  const bool only_one = reading.material_names.size() == 1 && !reading.default_material;
  for (FileTriangle& triangle : reading.triangles)
    if (triangle.material == no_material) triangle.material = only_one ? 0 : default_material(reading);
}

/// Makes unit vectors of the normals; those that have no direction become zero. Returns how many.
std::size_t normalize_all(std::vector<glm::vec3>& normals) {
  std::size_t unusable = 0;
  for (glm::vec3& normal : normals) {
    const double length = glm::length(glm::dvec3(normal));
    const bool usable = length > 0 && std::isfinite(length);
    normal = usable ? glm::vec3(glm::dvec3(normal) / length) : glm::vec3(0);
    unusable += usable ? 0 : 1;
  }
  return unusable;
}

/// Whether all corners have a normal, and one of them deviates from the triangle's own by more than what rounding in
/// the file explains (a thousandth: normals with three decimals).
bool is_smooth(const Reading& reading, const FileTriangle& triangle) {
  const glm::dvec3 a(reading.positions[triangle.positions[0]]);
  const glm::dvec3 b(reading.positions[triangle.positions[1]]);
  const glm::dvec3 c(reading.positions[triangle.positions[2]]);
  const glm::dvec3 area = glm::cross(b - a, c - a);
  if (!(glm::length(area) > 0)) return false;
  const glm::dvec3 flat = glm::normalize(area);
  bool deviates = false;
  for (const std::uint32_t index : triangle.normals) {
    if (index == no_normal || reading.normals[index] == glm::vec3(0)) return false;
    deviates = deviates || glm::length(glm::cross(flat, glm::dvec3(reading.normals[index]))) > 1e-3;
  }
  return deviates;
}

/// One vertex for each pair of position and normal that the triangles use.
void assemble(Reading& reading) {
  Scene& scene = reading.scene;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices;
  vertices.reserve(reading.positions.size());
  scene.triangles.reserve(reading.triangles.size());
  for (const FileTriangle& source : reading.triangles) {
    const bool smooth = is_smooth(reading, source);
    GpuTriangle triangle{.vertices = {}, .material = source.material | (smooth ? triangle_smooth : 0)};
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t normal = smooth ? source.normals[corner] : no_normal;
      const std::uint64_t key = std::uint64_t{normal} << 32 | source.positions[corner];
      const auto [entry, is_new] = vertices.try_emplace(key, static_cast<std::uint32_t>(scene.positions.size()));
      if (is_new) {
        scene.positions.push_back(reading.positions[source.positions[corner]]);
        scene.normals.push_back(smooth ? reading.normals[normal] : glm::vec3(0, 0, 1));
      }
      triangle.vertices[corner] = entry->second;
    }
    scene.triangles.push_back(triangle);
  }
}

}  // namespace

Scene load_obj(const std::filesystem::path& path, const ObjOptions& options) {
  Reading reading;
  reading.options = options;
  reading.scene.name = path.filename().string();
  WavefrontText text(path, [&](std::string_view statement) { return filter(reading, statement); });
  reading.text = &text;
  parse(reading);
  if (reading.triangles.empty()) throw Error(fmt::format("'{}' holds no triangles", path.string()));

  const auto warn = [&](std::string sentence) {
    reading.scene.warnings.push_back(fmt::format("{}: {}", path.string(), sentence));
  };
  if (const std::size_t unusable = normalize_all(reading.normals); unusable > 0)
    warn(fmt::format("{} vertex normals have no direction, so their triangles are flat", unusable));
  if (!reading.unknown_materials.empty())
    warn(fmt::format("unknown materials are grey: {}", fmt::join(reading.unknown_materials, ", ")));
  if (!reading.ignored.empty())
    warn(fmt::format("only faces are read, not the elements {}", fmt::join(reading.ignored, ", ")));
  assign_materials(reading);
  assemble(reading);
  return std::move(reading.scene);
}

}  // namespace tandem::pathtracer
