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

#include "base/printable.hpp"
#include "pathtracer/load/access/file_access.hpp"
#include "pathtracer/load/obj/obj_materials.hpp"
#include "pathtracer/load/obj/wavefront_text.hpp"
#include "pathtracer/scene/polygon.hpp"

namespace tandem::pathtracer {
namespace {

/// In place of the index of a normal or texture coordinate.
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
/// The intersection of a ray with a triangle needs products of three coordinates, which must be finite floats.
constexpr double largest_coordinate = 1e12;

/// Indices as in the file, from 1; 0 for none. Those that count from the end have been counted, but for those that lead
/// before the beginning.
struct FileCorner {
  int position;
  int texture_coordinate;
  int normal;
};

struct FileFace {
  std::size_t first_corner;
  std::size_t line;
  std::uint32_t use;  ///< of a material
};

/// A triangle whose positions and normals are numbered as in the file, from 0.
struct FileTriangle {
  std::array<std::uint32_t, 3> positions;
  std::array<std::uint32_t, 3> normals;              ///< or none
  std::array<std::uint32_t, 3> texture_coordinates;  ///< or none
  std::uint32_t material;
};

/// Why a vertex can be no corner.
struct UnusableVertex {
  std::size_t line;
  std::string why;
};

/// What the file has said so far. Faces are made of it at the end: statements may come in any order, and what no face
/// uses may be wrong.
struct Reading {
  WavefrontText* text = nullptr;
  Scene scene;  ///< its name, materials, textures and warnings
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> colors;        ///< of the positions up to the last that has one, linear
  glm::dvec3 read_position{0};          ///< of the vertex that is being read, as exactly as the file has it
  std::optional<glm::vec3> read_color;  ///< likewise
  std::map<std::size_t, UnusableVertex> unusable_positions;  ///< by index
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> texture_coordinates;
  std::vector<FileCorner> corners;  ///< of the faces, one face behind the other
  std::vector<FileFace> faces;
  std::vector<FileTriangle> triangles;
  std::optional<ObjMaterials> materials;
  std::uint32_t current_use = ObjMaterials::unnamed;
  std::size_t unusable_texture_coordinates = 0;
  std::size_t absent_normals = 0;              ///< corners whose index is out of range
  std::size_t absent_texture_coordinates = 0;  ///< likewise, where no texture needs them
  std::set<std::string> ignored;               ///< keywords of elements that are no surfaces this loader knows
};

/// "v x y z", or zeros in place of what a face cannot use.
std::string usable_position(Reading& reading, std::string_view text, const Statement& statement) {
  std::string_view rest = statement.rest;
  std::string why;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view word = take_word(rest);
    double value = 0;
    if (word.empty()) throw reading.text->error("a vertex has fewer than three coordinates");
    if (!why.empty()) continue;
    if (!parse_number(word, value) || !std::isfinite(static_cast<float>(value)))
      why = fmt::format("the vertex coordinate '{}' is not a finite number", shortened(word));
    else if (std::abs(value) > largest_coordinate)
      why = fmt::format("the vertex coordinate '{}' is beyond {:g}, the farthest that rays reach", shortened(word),
                        largest_coordinate);
    reading.read_position[axis] = value;
  }
  reading.read_color = parse_vertex_color(rest);
  if (why.empty()) return std::string(text);
  reading.unusable_positions.emplace(reading.positions.size(), UnusableVertex{reading.text->line(), why});
  return "v 0 0 0";
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

/// Each corner is "v", "v/vt", "v//vn" or "v/vt/vn"; parts behind may be empty too ("v//", "v/vt/"). Returns the
/// statement with the parts that are there, and without a comment behind it.
std::string checked_face(const Reading& reading, std::string_view text) {
  text = text.substr(0, text.find('#'));
  std::string_view rest = split_statement(text).rest;
  std::string checked = "f";
  for (std::string_view corner = take_word(rest); !corner.empty(); corner = take_word(rest)) {
    const std::string_view word = corner;
    std::array<std::string_view, 3> parts;
    std::size_t count = 0;
    for (bool more = true; more; ++count) {
      const std::size_t slash = std::min(corner.find('/'), corner.size());
      const std::string_view index = corner.substr(0, slash);
      int value = 0;
      if (count == 3 || (index.empty() && count == 0) ||
          (!index.empty() && (!parse_integer(index, value) || value == 0)))
        throw reading.text->error(fmt::format("'{}' is not a corner of a face", shortened(word)));
      parts[count] = index;
      more = slash < corner.size();
      corner.remove_prefix(std::min(slash + 1, corner.size()));
    }
    checked.append(" ").append(parts[0]);
    if (!parts[1].empty() || !parts[2].empty()) checked.append("/").append(parts[1]);
    if (!parts[2].empty()) checked.append("/").append(parts[2]);
  }
  return checked;
}

std::string filter(Reading& reading, std::string_view text) {
  const Statement statement = split_statement(text);
  if (statement.keyword == "v") return usable_position(reading, text, statement);
  if (statement.keyword == "vn") return std::string(text);
  if (statement.keyword == "vt") return usable_texture_coordinates(reading, statement);
  if (statement.keyword == "f") return checked_face(reading, text);
  if (statement.keyword == "usemtl") reading.current_use = reading.materials->use(statement.rest);
  if (statement.keyword == "mtllib") reading.materials->load_libraries(statement.rest);
  for (const std::string_view element : {"p", "l", "curv", "curv2", "surf"})
    if (statement.keyword == element) reading.ignored.emplace(element);
  return {};
}

/// An index that counts from the last element read so far, as one that counts from the first.
int counted(int index, std::size_t count) {
  const std::int64_t result = std::int64_t(count) + index + 1;
  return index < 0 && result > 0 ? static_cast<int>(result) : index;
}

bool is_there(int index, std::size_t count) { return index > 0 && std::int64_t{index} <= std::int64_t(count); }

void add_face(Reading& reading, std::span<const tinyobj::index_t> corners) {
  if (corners.size() < 3) throw reading.text->error("a face has fewer than three corners");
  reading.faces.push_back({reading.corners.size(), reading.text->line(), reading.current_use});
  for (const tinyobj::index_t& corner : corners)
    reading.corners.push_back({counted(corner.vertex_index, reading.positions.size()),
                               counted(corner.texcoord_index, reading.texture_coordinates.size()),
                               counted(corner.normal_index, reading.normals.size())});
}

void parse(Reading& reading) {
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = [](void* data, float x, float y, float z, float) {
    Reading& reading = *static_cast<Reading*>(data);
    // tinyobjloader loses count where a number has hundreds of digits.
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z))
      reading.unusable_positions.emplace(
          reading.positions.size(), UnusableVertex{reading.text->line(), "a vertex coordinate has too many digits"});
    if (reading.scene.origin == glm::dvec3(0))
      reading.positions.emplace_back(x, y, z);
    else
      reading.positions.emplace_back(reading.read_position - reading.scene.origin);
    if (!reading.read_color) return;
    reading.colors.resize(reading.positions.size(), glm::vec3(1));
    reading.colors.back() = *reading.read_color;
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

std::uint32_t position_of(const Reading& reading, const FileFace& face, const FileCorner& corner) {
  const std::size_t count = reading.positions.size();
  if (!is_there(corner.position, count))
    throw reading.text->error_at(
        face.line, fmt::format("the vertex index {} is out of range: there are {}", corner.position, count));
  const auto index = static_cast<std::uint32_t>(corner.position - 1);
  const auto unusable = reading.unusable_positions.find(index);
  if (unusable != reading.unusable_positions.end())
    throw reading.text->error_at(unusable->second.line, unusable->second.why);
  return index;
}

std::uint32_t normal_of(Reading& reading, const FileCorner& corner) {
  if (is_there(corner.normal, reading.normals.size())) return static_cast<std::uint32_t>(corner.normal - 1);
  reading.absent_normals += corner.normal != 0 ? 1 : 0;
  return none;
}

std::uint32_t texture_coordinate_of(Reading& reading, const FileFace& face, const FileCorner& corner, bool is_needed) {
  const std::size_t count = reading.texture_coordinates.size();
  const int index = corner.texture_coordinate;
  if (is_there(index, count)) return static_cast<std::uint32_t>(index - 1);
  if (index != 0 && is_needed)
    throw reading.text->error_at(
        face.line, fmt::format("the texture coordinate index {} is out of range: there are {}", index, count));
  reading.absent_texture_coordinates += index != 0 ? 1 : 0;
  return none;
}

void add_triangles(Reading& reading, const FileFace& face, std::span<const FileCorner> corners,
                   std::uint32_t material) {
  const bool is_textured = has_texture(reading.scene.materials[material]);
  std::vector<std::uint32_t> positions, normals, texture_coordinates;
  std::vector<glm::vec3> polygon;
  for (const FileCorner& corner : corners) {
    positions.push_back(position_of(reading, face, corner));
    normals.push_back(normal_of(reading, corner));
    texture_coordinates.push_back(texture_coordinate_of(reading, face, corner, is_textured));
    polygon.push_back(reading.positions[positions.back()]);
  }
  try {
    for (const auto& [a, b, c] : triangulate(polygon))
      reading.triangles.push_back({{positions[a], positions[b], positions[c]},
                                   {normals[a], normals[b], normals[c]},
                                   {texture_coordinates[a], texture_coordinates[b], texture_coordinates[c]},
                                   material});
  } catch (const Error& error) {
    throw reading.text->error_at(face.line, error.what());
  }
}

/// Makes triangles of the faces, now that all elements and materials are known.
void resolve_faces(Reading& reading) {
  std::vector<bool> used;
  for (const FileFace& face : reading.faces) {
    used.resize(std::max<std::size_t>(used.size(), face.use + std::size_t{1}));
    used[face.use] = true;
  }
  const std::vector<std::uint32_t> materials = reading.materials->resolve(std::move(used));
  for (std::size_t i = 0; i < reading.faces.size(); ++i) {
    const FileFace& face = reading.faces[i];
    const std::size_t end = i + 1 < reading.faces.size() ? reading.faces[i + 1].first_corner : reading.corners.size();
    add_triangles(reading, face, std::span(reading.corners).subspan(face.first_corner, end - face.first_corner),
                  materials[face.use]);
  }
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
    const bool textured = has_texture(scene.materials[source.material]);
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
        if (source.positions[corner] < reading.colors.size()) {
          scene.attributes.resize(scene.positions.size());
          scene.attributes.back().color = reading.colors[source.positions[corner]];
        }
        if (!scene.textures.empty())
          scene.texture_coordinates.push_back(
              texture_coordinate == none ? glm::vec2(0) : reading.texture_coordinates[texture_coordinate]);
      }
      triangle.vertices[corner] = entry->second;
    }
    scene.triangles.push_back(triangle);
    const auto is_colored = [&](std::uint32_t position) {
      return position < reading.colors.size() && reading.colors[position] != glm::vec3(1);
    };
    if (std::ranges::any_of(source.positions, is_colored))
      scene.materials[source.material].attributes |= vertex_attribute::color;
  }
  if (!scene.attributes.empty()) scene.attributes.resize(scene.positions.size());
  return lacking;
}

}  // namespace

Scene load_obj(const std::filesystem::path& path, const LoadOptions& options, const glm::dvec3& origin) {
  Reading reading;
  reading.scene.origin = origin;
  reading.scene.name = path.filename().string();
  WavefrontText text(path, [&](std::string_view statement) { return filter(reading, statement); });
  reading.text = &text;
  reading.materials.emplace(text, options_within(path, options), reading.scene);
  parse(reading);
  if (reading.faces.empty()) throw Error(fmt::format("'{}' holds no triangles", path.string()));
  resolve_faces(reading);

  const auto warn = [&](std::string sentence) {
    reading.scene.warnings.push_back(fmt::format("{}: {}", path.string(), sentence));
  };
  if (const std::size_t unusable = reading.unusable_positions.size(); unusable > 0)
    warn(fmt::format("{} vertices cannot be used, and no face does ({})", unusable,
                     reading.unusable_positions.begin()->second.why));
  if (const std::size_t unusable = normalize_all(reading.normals); unusable > 0)
    warn(fmt::format("{} vertex normals have no direction, so their triangles are flat", unusable));
  if (reading.absent_normals > 0)
    warn(fmt::format("{} corners name normals that the file does not have, so their triangles are flat",
                     reading.absent_normals));
  if (reading.absent_texture_coordinates > 0)
    warn(fmt::format("{} corners name texture coordinates that the file does not have, and no texture needs",
                     reading.absent_texture_coordinates));
  if (!reading.ignored.empty())
    warn(fmt::format("only faces are read, not the elements {}", fmt::join(reading.ignored, ", ")));
  if (const std::size_t lacking = assemble(reading); lacking > 0)
    warn(fmt::format(
        "{} triangles with a texture lack texture coordinates, so they have those of its lower left corner", lacking));
  if (!reading.scene.textures.empty() && reading.unusable_texture_coordinates > 0)
    warn(fmt::format("{} texture coordinates are not finite numbers, and count as 0",
                     reading.unusable_texture_coordinates));
  return std::move(reading.scene);
}

}  // namespace tandem::pathtracer
