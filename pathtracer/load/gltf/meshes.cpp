#include "pathtracer/load/gltf/meshes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "pathtracer/load/gltf/accessor.hpp"
#include "pathtracer/load/gltf/morphs.hpp"

namespace tandem::pathtracer {
namespace {

/// An attribute of a primitive, or nothing where it has none.
std::optional<GltfValues> attribute(const GltfDocument& document, const tinygltf::Primitive& source,
                                    const GltfPrimitive& primitive, const std::string& name, std::size_t least,
                                    std::size_t most) {
  const auto entry = source.attributes.find(name);
  if (entry == source.attributes.end()) return std::nullopt;
  GltfValues values = gltf_vectors(document, entry->second, least, most, fmt::format("{} of {}", name, primitive.name));
  if (!primitive.positions.empty() && values.count != primitive.positions.size())
    throw gltf_error(
        document, primitive.name,
        fmt::format("{} has {} elements, but POSITION has {}", name, values.count, primitive.positions.size()));
  return values;
}

std::vector<glm::vec3> vectors(const GltfValues& values) {
  std::vector<glm::vec3> result(values.count);
  for (std::size_t i = 0; i < values.count; ++i)
    result[i] = {values.values[3 * i], values.values[3 * i + 1], values.values[3 * i + 2]};
  return result;
}

/// Triples of corners from a list, a strip or a fan (glTF 2.0, section 3.7.2.1).
std::vector<std::array<std::uint32_t, 3>> assemble(const GltfDocument& document, int mode,
                                                   const std::vector<std::uint32_t>& corners, std::string_view owner) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    if (corners.size() % 3 != 0)
      throw gltf_error(document, owner, fmt::format("{} corners make no whole triangles", corners.size()));
    for (std::size_t i = 0; i < corners.size(); i += 3)
      triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    return triangles;
  }
  for (std::size_t i = 0; i + 2 < corners.size(); ++i)
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
      triangles.push_back({corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
    else
      triangles.push_back({corners[i + 1], corners[i + 2], corners[0]});
  return triangles;
}

void read_normals(GltfDocument& document, const tinygltf::Primitive& source, const std::vector<double>& weights,
                  GltfPrimitive& primitive) {
  const auto values = attribute(document, source, primitive, "NORMAL", 3, 3);
  if (!values) return;
  primitive.normals = vectors(*values);
  apply_gltf_morphs(document, source, weights, "NORMAL", primitive.name, primitive.normals);
  const bool have_directions = std::ranges::all_of(primitive.normals, [](glm::vec3 normal) {
    const float length = glm::length(normal);
    return length > 0 && std::isfinite(length);
  });
  if (!have_directions)
    gltf_warn(document, fmt::format("{} has normals without direction, whose triangles are flat", primitive.name));
}

void read_texture_coordinates(GltfDocument& document, const tinygltf::Primitive& source, int set,
                              const GltfPrimitive& primitive, std::vector<glm::vec2>& coordinates) {
  if (set < 0) return;
  const auto values = attribute(document, source, primitive, fmt::format("TEXCOORD_{}", set), 2, 2);
  if (!values) {
    gltf_warn(document, fmt::format("{} lacks TEXCOORD_{}, so its textures show the colour of their upper left corner",
                                    primitive.name, set));
    return;
  }
  bool all_finite = true;
  for (std::size_t i = 0; i < values->count; ++i) {
    const glm::vec2 coordinate{values->values[2 * i], 1 - values->values[2 * i + 1]};
    const bool finite = std::isfinite(coordinate.x) && std::isfinite(coordinate.y);
    all_finite = all_finite && finite;
    coordinates.push_back(finite ? coordinate : glm::vec2(0));
  }
  if (!all_finite)
    gltf_warn(document, fmt::format("{} has texture coordinates that are not finite numbers", primitive.name));
}

/// Tangents of flat triangles mean nothing (glTF 2.0, 3.7.2.1).
void read_tangents(GltfDocument& document, const tinygltf::Primitive& source, const std::vector<double>& weights,
                   const GltfMaterial& material, GltfPrimitive& primitive) {
  if (primitive.normals.empty() || material.material.normal_texture == no_texture) return;
  const auto values = attribute(document, source, primitive, "TANGENT", 4, 4);
  if (!values) return;
  std::vector<glm::vec3> directions(values->count);
  for (std::size_t i = 0; i < values->count; ++i)
    directions[i] = {values->values[4 * i], values->values[4 * i + 1], values->values[4 * i + 2]};
  apply_gltf_morphs(document, source, weights, "TANGENT", primitive.name, directions);
  for (const glm::vec3& direction : directions)
    if (const float length = glm::length(direction); !(length > 0 && std::isfinite(length)))
      return gltf_warn(document,
                       fmt::format("{} has tangents without direction, which have no effect", primitive.name));
  for (std::size_t i = 0; i < values->count; ++i)
    primitive.tangents.emplace_back(directions[i], values->values[4 * i + 3] < 0 ? -1.0f : 1.0f);
  primitive.attributes |= vertex_attribute::tangent;
}

void read_colors(GltfDocument& document, const tinygltf::Primitive& source, const GltfMaterial& material,
                 GltfPrimitive& primitive) {
  const auto values = attribute(document, source, primitive, "COLOR_0", 3, 4);
  if (!values || values->count == 0) return;
  const std::size_t n = values->components;
  bool is_in_range = true;
  for (std::size_t i = 0; i < values->count; ++i) {
    glm::vec4 color(1);
    for (std::size_t channel = 0; channel < n; ++channel) {
      const float number = values->values[n * i + channel];
      if (!std::isfinite(number))
        throw gltf_error(document, primitive.name, fmt::format("COLOR_0 of vertex {} is not finite", i));
      is_in_range = is_in_range && number >= 0 && number <= 1;
      color[static_cast<int>(channel)] = std::clamp(number, 0.0f, 1.0f);
    }
    if (!material.has_alpha) color.a = 1;
    primitive.colors.push_back(color);
  }
  if (!is_in_range)
    gltf_warn(document, fmt::format("{} has colours (COLOR_0) beyond 0 and 1, which count as 0 and 1", primitive.name));
  if (std::ranges::all_of(primitive.colors, [&](const glm::vec4& color) { return color == primitive.colors[0]; })) {
    primitive.color = primitive.colors[0];
    primitive.colors.clear();
    return;
  }
  primitive.attributes |= vertex_attribute::color;
  if (material.emits_color) primitive.attributes |= vertex_attribute::emission;
  if (std::ranges::any_of(primitive.colors, [](const glm::vec4& color) { return color.a < 1; }))
    primitive.attributes |= vertex_attribute::opacity;
}

/// All sets of joints and weights, one vertex after the other.
void read_joints(const GltfDocument& document, const tinygltf::Primitive& source, GltfPrimitive& primitive) {
  std::vector<std::pair<GltfValues, GltfValues>> sets;
  for (std::size_t set = 0;; ++set) {
    const auto joints = attribute(document, source, primitive, fmt::format("JOINTS_{}", set), 4, 4);
    const auto weights = attribute(document, source, primitive, fmt::format("WEIGHTS_{}", set), 4, 4);
    if (joints.has_value() != weights.has_value())
      throw gltf_error(document, primitive.name, fmt::format("has only one of JOINTS_{} and WEIGHTS_{}", set, set));
    if (!joints) break;
    sets.emplace_back(*joints, *weights);
  }
  for (std::size_t vertex = 0; vertex < primitive.positions.size(); ++vertex)
    for (const auto& [joints, weights] : sets)
      for (std::size_t i = 4 * vertex; i < 4 * vertex + 4; ++i) {
        const float weight = weights.values[i];
        if (!std::isfinite(weight))
          throw gltf_error(document, primitive.name, fmt::format("a weight of vertex {} is not finite", vertex));
        primitive.weights.push_back(weight);
        // What is no whole number is out of range.
        const bool is_index = joints.values[i] >= 0 && joints.values[i] < 65536;
        primitive.joints.push_back(is_index ? static_cast<std::uint32_t>(joints.values[i]) : 0xffffffffu);
      }
}

/// Nothing for a primitive without triangles.
std::optional<GltfPrimitive> read_primitive(GltfDocument& document, const std::vector<GltfMaterial>& materials,
                                            const tinygltf::Primitive& source, const std::vector<double>& weights,
                                            std::string name) {
  const bool has_triangles = source.mode >= TINYGLTF_MODE_TRIANGLES && source.mode <= TINYGLTF_MODE_TRIANGLE_FAN;
  if (source.mode < TINYGLTF_MODE_POINTS || source.mode > TINYGLTF_MODE_TRIANGLE_FAN)
    throw gltf_error(document, name, fmt::format("{} is not a primitive mode", source.mode));
  if (!has_triangles) {
    gltf_warn(document, "points and lines are not drawn");
    return std::nullopt;
  }
  GltfPrimitive primitive;
  primitive.name = std::move(name);
  const auto positions = attribute(document, source, primitive, "POSITION", 3, 3);
  if (!positions) {
    gltf_warn(document, fmt::format("{} has no POSITION and is not drawn", primitive.name));
    return std::nullopt;
  }
  if (positions->count > 0xffffffffu)
    throw gltf_error(document, primitive.name, "has more vertices than 32 bits count");
  primitive.positions = vectors(*positions);
  apply_gltf_morphs(document, source, weights, "POSITION", primitive.name, primitive.positions);

  primitive.material = materials.size() - 1;
  if (source.material >= 0) {
    gltf_at(document, document.model.materials, source.material, "material", primitive.name);
    primitive.material = static_cast<std::size_t>(source.material);
  }
  read_normals(document, source, weights, primitive);
  const GltfMaterial& material = materials[primitive.material];
  for (std::size_t i = 0; i < material.coordinates.size(); ++i)
    read_texture_coordinates(document, source, material.coordinates[i], primitive, primitive.texture_coordinates[i]);
  if (material.coordinates[1] >= 0) primitive.attributes |= vertex_attribute::texture_coordinates;
  read_tangents(document, source, weights, material, primitive);
  read_colors(document, source, material, primitive);
  read_joints(document, source, primitive);

  std::vector<std::uint32_t> corners;
  if (source.indices >= 0) {
    corners = gltf_indices(document, source.indices, primitive.positions.size(), primitive.name);
  } else {
    corners.resize(primitive.positions.size());
    std::iota(corners.begin(), corners.end(), 0u);
  }
  primitive.triangles = assemble(document, source.mode, corners, primitive.name);
  return primitive;
}

}  // namespace

std::vector<GltfPrimitive> read_gltf_mesh(GltfDocument& document, const std::vector<GltfMaterial>& materials, int index,
                                          const std::vector<double>& weights, std::string_view owner) {
  const tinygltf::Mesh& mesh = gltf_at(document, document.model.meshes, index, "mesh", owner);
  const std::string name = gltf_name("mesh", static_cast<std::size_t>(index), mesh.name);
  const std::vector<double>& used = weights.empty() ? mesh.weights : weights;
  std::vector<GltfPrimitive> primitives;
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    auto primitive =
        read_primitive(document, materials, mesh.primitives[i], used, fmt::format("primitive {} of {}", i, name));
    if (primitive) primitives.push_back(std::move(*primitive));
    if (!used.empty() && used.size() != mesh.primitives[i].targets.size())
      gltf_warn(document, fmt::format("primitive {} of {} has {} morph targets, but {} weights for them", i, name,
                                      mesh.primitives[i].targets.size(), used.size()));
  }
  return primitives;
}

}  // namespace tandem::pathtracer
