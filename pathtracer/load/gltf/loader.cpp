#include "pathtracer/load/gltf/loader.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "pathtracer/load/gltf/materials.hpp"
#include "pathtracer/load/gltf/meshes.hpp"
#include "pathtracer/load/gltf/nodes.hpp"
#include "pathtracer/load/gltf/skins.hpp"

namespace tandem::pathtracer {
namespace {

/// The intersection of a ray with a triangle needs products of three coordinates, which must be finite floats.
constexpr double largest_coordinate = 1e12;
/// The most vertices that the indices of triangles can address.
constexpr std::size_t most_vertices = std::numeric_limits<std::uint32_t>::max();

struct Reading {
  GltfDocument document;
  Scene scene;
  std::vector<GltfMaterial> materials;
  std::vector<GltfNode> nodes;
  /// Those that nodes have used so far, with their weights of morph targets.
  std::map<std::pair<int, std::vector<double>>, std::vector<GltfPrimitive>> meshes;
  /// Index into the scene's materials, by the document's, GpuMaterial::attributes and a colour.
  std::map<std::tuple<std::size_t, std::uint32_t, std::array<float, 4>>, std::uint32_t> colored;
};

/// The scene's material for a primitive. Those of the file keep their index; others are appended.
std::uint32_t scene_material(Reading& reading, const GltfPrimitive& primitive) {
  const GltfMaterial& material = reading.materials[primitive.material];
  const bool is_default = primitive.material + 1 == reading.materials.size();
  if (primitive.color == glm::vec4(1) && primitive.attributes == 0 && !is_default)
    return static_cast<std::uint32_t>(primitive.material);
  const auto [entry, is_new] =
      reading.colored.try_emplace({primitive.material,
                                   primitive.attributes,
                                   {primitive.color.r, primitive.color.g, primitive.color.b, primitive.color.a}},
                                  static_cast<std::uint32_t>(reading.scene.materials.size()));
  if (is_new) {
    reading.scene.materials.push_back(colored_material(material, primitive.color, primitive.attributes));
    reading.scene.material_names.push_back(material.name);
  }
  return entry->second;
}

/// Transforms normals with the transform of their mesh: its cofactors are its inverse transposed times its determinant,
/// and exist where it has no inverse.
class NormalTransform {
 public:
  explicit NormalTransform(const glm::dmat3& transform)
      : cofactors_(glm::cross(transform[1], transform[2]), glm::cross(transform[2], transform[0]),
                   glm::cross(transform[0], transform[1])),
        is_mirror_(glm::determinant(transform) < 0) {}

  bool is_mirror() const { return is_mirror_; }

  /// Of unit length, or 0 where it has no direction.
  glm::vec3 operator()(glm::vec3 normal) const {
    const glm::dvec3 unscaled = cofactors_ * glm::dvec3(normal) * (is_mirror_ ? -1.0 : 1.0);
    const double length = glm::length(unscaled);
    return length > 0 && std::isfinite(length) ? glm::vec3(unscaled / length) : glm::vec3(0);
  }

 private:
  glm::dmat3 cofactors_;
  bool is_mirror_;
};

/// What a vertex has of its own, but its second texture coordinates.
GpuVertexAttributes attributes_of(const GltfPrimitive& primitive, std::uint32_t vertex, const glm::dmat3& transform) {
  GpuVertexAttributes attributes;
  if (!primitive.colors.empty()) {
    attributes.color = glm::vec3(primitive.colors[vertex]);
    attributes.opacity = primitive.colors[vertex].a;
  }
  if (!primitive.tangents.empty()) {
    const glm::vec4& tangent = primitive.tangents[vertex];
    const glm::dvec3 direction = transform * glm::dvec3(tangent);
    const double length = glm::length(direction);
    if (length > 0 && std::isfinite(length)) attributes.tangent = glm::vec4(glm::vec3(direction / length), tangent.w);
    // A mirrored triangle has its normal turned round too.
    if (glm::determinant(transform) < 0) attributes.tangent.w = -attributes.tangent.w;
  }
  return attributes;
}

/// Whether all corners have a normal, and one of them deviates from the triangle's own by more than a thousandth.
bool is_smooth(const Scene& scene, const GpuTriangle& triangle) {
  const glm::dvec3 a(scene.positions[triangle.vertices[0]]);
  const glm::dvec3 b(scene.positions[triangle.vertices[1]]);
  const glm::dvec3 c(scene.positions[triangle.vertices[2]]);
  const glm::dvec3 area = glm::cross(b - a, c - a);
  if (!(glm::length(area) > 0)) return false;
  const glm::dvec3 flat = glm::normalize(area);
  bool deviates = false;
  for (const std::uint32_t vertex : triangle.vertices) {
    const glm::vec3 normal = scene.normals[vertex];
    if (normal == glm::vec3(0)) return false;
    deviates = deviates || glm::length(glm::cross(flat, glm::dvec3(normal))) > 1e-3;
  }
  return deviates;
}

glm::vec3 checked_position(const Reading& reading, const GltfNode& node, const GltfPrimitive& primitive,
                           const glm::dmat4& transform, std::uint32_t vertex) {
  const glm::dvec3 position(transform * glm::dvec4(glm::dvec3(primitive.positions[vertex]), 1));
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(position[axis]) <= largest_coordinate))
      throw gltf_error(reading.document, primitive.name,
                       fmt::format("vertex {} at {} is not within {:g}, the farthest that rays reach", vertex,
                                   node.name, largest_coordinate));
  return glm::vec3(position);
}

/// Adds the triangles of a primitive at a node, with the vertices that they use.
/// @param joints of its skin; none: it has no skin
void add_primitive(Reading& reading, const GltfNode& node, const GltfPrimitive& primitive,
                   const std::vector<glm::dmat4>& joints) {
  Scene& scene = reading.scene;
  std::vector<glm::dmat4> transforms;  // of each vertex of a skin
  if (!joints.empty()) {
    if (primitive.joints.empty())
      gltf_warn(reading.document, fmt::format("{} has no joints, so its skin has no effect", primitive.name));
    else
      transforms = gltf_vertex_transforms(reading.document, primitive, joints);
  }
  const auto transform_of = [&](std::uint32_t corner) -> const glm::dmat4& {
    return transforms.empty() ? node.transform : transforms[corner];
  };
  const NormalTransform of_node{glm::dmat3(node.transform)};
  const auto to_world = [&](std::uint32_t corner) {
    return transforms.empty() ? of_node : NormalTransform(glm::dmat3(transforms[corner]));
  };
  const auto coordinates = [&](std::size_t set, std::uint32_t corner) {
    const std::vector<glm::vec2>& given = primitive.texture_coordinates[set];
    return given.empty() ? glm::vec2(0, 1) : given[corner];
  };
  const std::uint32_t material = scene_material(reading, primitive);
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> vertices(primitive.positions.size(), unused);
  if (primitive.positions.size() >= most_vertices - scene.positions.size())
    throw gltf_error(reading.document, node.name, "the scene has more vertices than 32 bits count");
  for (const std::array<std::uint32_t, 3>& corners : primitive.triangles) {
    GpuTriangle triangle{.vertices = {}, .material = material};
    const bool is_mirrored = to_world(corners[0]).is_mirror();
    for (std::size_t i = 0; i < 3; ++i) {
      // A mirrored triangle is seen counter-clockwise from outside again.
      const std::uint32_t corner = corners[is_mirrored && i > 0 ? 3 - i : i];
      if (vertices[corner] == unused) {
        vertices[corner] = static_cast<std::uint32_t>(scene.positions.size());
        scene.positions.push_back(checked_position(reading, node, primitive, transform_of(corner), corner));
        scene.normals.push_back(primitive.normals.empty() ? glm::vec3(0) : to_world(corner)(primitive.normals[corner]));
        scene.texture_coordinates.push_back(coordinates(0, corner));
        if (primitive.attributes != 0) {
          scene.attributes.resize(scene.positions.size());
          scene.attributes.back() = attributes_of(primitive, corner, glm::dmat3(transform_of(corner)));
          scene.attributes.back().texture_coordinates = coordinates(1, corner);
        }
      }
      triangle.vertices[i] = vertices[corner];
    }
    if (is_smooth(scene, triangle)) triangle.material |= triangle_smooth;
    scene.triangles.push_back(triangle);
  }
}

void add_mesh(Reading& reading, const GltfNode& node) {
  const int index = node.source->mesh;
  const std::pair key{index, node.source->weights};
  auto entry = reading.meshes.find(key);
  if (entry == reading.meshes.end())
    entry =
        reading.meshes.emplace(key, read_gltf_mesh(reading.document, reading.materials, index, key.second, node.name))
            .first;
  std::vector<glm::dmat4> joints;
  if (node.source->skin >= 0)
    joints = gltf_joint_matrices(reading.document, reading.nodes, node.source->skin, node.name);
  for (const GltfPrimitive& primitive : entry->second) add_primitive(reading, node, primitive, joints);
}

void add_camera(Reading& reading, const GltfNode& node) {
  if (is_hidden(node))
    return gltf_warn(reading.document, fmt::format("the camera of {} is hidden: its node is scaled to 0", node.name));
  if (reading.scene.camera)
    return gltf_warn(reading.document, "of several cameras the first in the order of the nodes counts");
  reading.scene.camera = read_gltf_camera(reading.document, node);
}

void add_light(Reading& reading, const GltfNode& node, const tinygltf::Value& extension) {
  const tinygltf::Value* index = gltf_member(extension, "light");
  if (index == nullptr || !index->IsInt())
    throw gltf_error(reading.document, node.name, "its KHR_lights_punctual names no light");
  if (is_hidden(node))
    return gltf_warn(reading.document, fmt::format("the light of {} is hidden: its node is scaled to 0", node.name));
  reading.scene.lights.push_back(read_gltf_light(reading.document, index->GetNumberAsInt(), node));
}

/// Normals without direction are in no smooth triangle, where they would mean something.
void fill_normals(Scene& scene) {
  for (glm::vec3& normal : scene.normals)
    if (normal == glm::vec3(0)) normal = glm::vec3(0, 0, 1);
}

}  // namespace

Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options, const glm::dvec3& origin) {
  Reading reading;
  reading.scene.origin = origin;
  reading.document = read_gltf(path, options);
  reading.scene.name = path.filename().string();
  reading.materials = read_gltf_materials(reading.document, reading.scene);
  // But the last, that of primitives without one, which comes when it is needed.
  for (std::size_t i = 0; i + 1 < reading.materials.size(); ++i) {
    reading.scene.materials.push_back(colored_material(reading.materials[i], glm::vec4(1)));
    reading.scene.material_names.push_back(reading.materials[i].name);
  }
  reading.nodes = place_gltf_nodes(reading.document);
  for (GltfNode& node : reading.nodes) node.transform[3] -= glm::dvec4(origin, 0);
  for (const GltfNode& node : reading.nodes) {
    const bool is_skinned = node.source->skin >= 0;  // its own transform does not count
    if (node.source->mesh >= 0 && (is_skinned || !is_hidden(node))) add_mesh(reading, node);
    if (node.source->camera >= 0) add_camera(reading, node);
    if (const tinygltf::Value* light = gltf_extension(node.source->extensions, "KHR_lights_punctual"))
      add_light(reading, node, *light);
  }
  if (reading.document.has_animations) gltf_warn(reading.document, "animations are not played");
  if (reading.scene.triangles.empty()) throw Error(fmt::format("'{}' holds no triangles", path.string()));
  fill_normals(reading.scene);
  if (!reading.scene.attributes.empty()) reading.scene.attributes.resize(reading.scene.positions.size());
  if (reading.scene.textures.empty()) reading.scene.texture_coordinates.clear();
  reading.scene.warnings = std::move(reading.document.warnings);
  return std::move(reading.scene);
}

}  // namespace tandem::pathtracer
