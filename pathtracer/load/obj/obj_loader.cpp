#include "pathtracer/load/obj/obj_loader.hpp"

#include <algorithm>
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

#include "pathtracer/load/obj/mtl_loader.hpp"
#include "pathtracer/load/obj/mtl_texture.hpp"
#include "pathtracer/load/obj/wavefront_text.hpp"
#include "pathtracer/scene/polygon.hpp"

namespace tandem::pathtracer {
namespace {

/// In place of the index of a normal or texture coordinate.
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
/// Of a triangle before the first usemtl, until the end of the file.
constexpr std::uint32_t no_material = triangle_smooth - 1;
constexpr glm::vec3 grey{0.5f};
/// The intersection of a ray with a triangle needs products of three coordinates, which must be finite floats.
constexpr double largest_coordinate = 1e12;

/// A triangle whose positions and normals are still numbered as in the file, from 0.
struct FileTriangle {
  std::array<std::uint32_t, 3> positions;
  std::array<std::uint32_t, 3> normals;              ///< or none
  std::array<std::uint32_t, 3> texture_coordinates;  ///< or none
  std::uint32_t material;
};

/// What the file has said so far.
struct Reading {
  WavefrontText* text = nullptr;
  ObjOptions options;
  Scene scene;  ///< its name, materials, textures and warnings
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> texture_coordinates;
  std::vector<FileTriangle> triangles;
  std::map<std::string, std::uint32_t, std::less<>> material_names;
  std::uint32_t current_material = no_material;
  std::optional<std::uint32_t> default_material;
  std::set<std::string> libraries;
  TextureFiles textures;
  std::set<std::filesystem::path> missing_textures;
  std::set<std::string> unknown_materials;
  std::size_t unusable_texture_coordinates = 0;
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

/// Gives a material its textures. `folder` is that of the MTL file.
void load_textures(Reading& reading, NamedMaterial& entry, const std::filesystem::path& folder) {
  for (const MaterialMap& map : entry.maps) {
    if (const auto file = find_texture(folder, map.file)) {
      entry.material.*map.member = texture_of(reading.scene, reading.textures, *file, map);
      continue;
    }
    const std::filesystem::path path = folder / map.file;
    const std::string sentence = fmt::format("the texture '{}' does not exist", path.string());
    if (!reading.options.allow_missing_mtl) throw reading.text->error(sentence);
    if (reading.missing_textures.insert(path).second)
      reading.scene.warnings.push_back(reading.text->error(sentence).what());
  }
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
  for (NamedMaterial& entry : load_mtl(path, reading.scene.warnings)) {
    if (reading.material_names.contains(entry.name)) continue;
    load_textures(reading, entry, path.parent_path());
    reading.material_names.emplace(entry.name, add_material(reading, entry.name, entry.material));
  }
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
      throw reading.text->error(fmt::format("the vertex coordinate '{}' is not a finite number", word));
    if (std::abs(value) > largest_coordinate)
      throw reading.text->error(fmt::format("the vertex coordinate '{}' is beyond {:g}, the farthest that rays reach",
                                            word, largest_coordinate));
  }
}

/// Exporters write coordinates that are no numbers, where nothing needs them.
std::string usable_texture_coordinates(Reading& reading, const Statement& statement) {
  std::string_view rest = statement.rest;
  std::array<double, 2> values{};
  bool usable = true;
  for (double& value : values) {
    const std::string_view word = take_word(rest);
    const bool absent = &value == &values[1] && word.empty();  // a texture of one dimension
    usable = usable && (absent || (parse_number(word, value) && std::isfinite(static_cast<float>(value))));
  }
  reading.unusable_texture_coordinates += usable ? 0 : 1;
  return usable ? fmt::format("vt {} {}", static_cast<float>(values[0]), static_cast<float>(values[1])) : "vt 0 0";
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
        throw reading.text->error(fmt::format("'{}' is not a corner of a face", word));
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
  if (statement.keyword == "vt") return usable_texture_coordinates(reading, statement);
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

bool has_texture(const Reading& reading, std::uint32_t material) {
  return material != no_material && pathtracer::has_texture(reading.scene.materials[material]);
}

/// What no texture needs may be wrong.
std::uint32_t resolve_texture_coordinate(const Reading& reading, int index) {
  const std::size_t count = reading.texture_coordinates.size();
  if (index == 0) return none;
  if (!has_texture(reading, reading.current_material) && std::abs(index) > std::int64_t(count)) return none;
  return resolve(reading, index, count, "texture coordinate");
}

void add_face(Reading& reading, std::span<const tinyobj::index_t> corners) {
  if (corners.size() < 3) throw reading.text->error("a face has fewer than three corners");
  std::vector<std::uint32_t> positions, normals, texture_coordinates;
  std::vector<glm::vec3> polygon;
  for (const tinyobj::index_t& corner : corners) {
    positions.push_back(resolve(reading, corner.vertex_index, reading.positions.size(), "vertex"));
    normals.push_back(
        corner.normal_index == 0 ? none : resolve(reading, corner.normal_index, reading.normals.size(), "normal"));
    texture_coordinates.push_back(resolve_texture_coordinate(reading, corner.texcoord_index));
    polygon.push_back(reading.positions[positions.back()]);
  }
  for (const auto& [a, b, c] : triangulate(polygon))
    reading.triangles.push_back({{positions[a], positions[b], positions[c]},
                                 {normals[a], normals[b], normals[c]},
                                 {texture_coordinates[a], texture_coordinates[b], texture_coordinates[c]},
                                 reading.current_material});
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
  callbacks.texcoord_cb = [](void* data, float u, float v, float) {
    static_cast<Reading*>(data)->texture_coordinates.emplace_back(u, v);
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
    if (index == none || reading.normals[index] == glm::vec3(0)) return false;
    deviates = deviates || glm::length(glm::cross(flat, glm::dvec3(reading.normals[index]))) > 1e-3;
  }
  return deviates;
}

/// What makes a vertex one of its own: position, normal and texture coordinate.
using VertexKey = std::array<std::uint32_t, 3>;

struct VertexHash {
  std::size_t operator()(const VertexKey& key) const noexcept {
    std::uint64_t hash = 0;
    for (const std::uint32_t part : key) hash = (hash ^ part) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(hash ^ hash >> 32);
  }
};

/// One vertex for each combination that the triangles use. Returns how many triangles lack texture coordinates.
std::size_t assemble(Reading& reading) {
  Scene& scene = reading.scene;
  std::size_t lacking = 0;
  std::unordered_map<VertexKey, std::uint32_t, VertexHash> vertices;
  vertices.reserve(reading.positions.size());
  scene.triangles.reserve(reading.triangles.size());
  for (const FileTriangle& source : reading.triangles) {
    const bool smooth = is_smooth(reading, source);
    const bool textured = has_texture(reading, source.material);
    if (textured && std::ranges::count(source.texture_coordinates, none) > 0) ++lacking;
    GpuTriangle triangle{.vertices = {}, .material = source.material | (smooth ? triangle_smooth : 0)};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t normal = smooth ? source.normals[corner] : none;
      const std::uint32_t texture_coordinate = textured ? source.texture_coordinates[corner] : none;
      const auto [entry, is_new] = vertices.try_emplace({source.positions[corner], normal, texture_coordinate},
                                                        static_cast<std::uint32_t>(scene.positions.size()));
      if (is_new) {
        scene.positions.push_back(reading.positions[source.positions[corner]]);
        scene.normals.push_back(smooth ? reading.normals[normal] : glm::vec3(0, 0, 1));
        if (!scene.textures.empty())
          scene.texture_coordinates.push_back(
              texture_coordinate == none ? glm::vec2(0) : reading.texture_coordinates[texture_coordinate]);
      }
      triangle.vertices[corner] = entry->second;
    }
    scene.triangles.push_back(triangle);
  }
  return lacking;
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
  if (const std::size_t lacking = assemble(reading); lacking > 0)
    warn(fmt::format(
        "{} triangles with a texture lack texture coordinates, so they have those of its lower left corner", lacking));
  if (!reading.scene.textures.empty() && reading.unusable_texture_coordinates > 0)
    warn(fmt::format("{} texture coordinates are not finite numbers, and count as 0",
                     reading.unusable_texture_coordinates));
  return std::move(reading.scene);
}

}  // namespace tandem::pathtracer
