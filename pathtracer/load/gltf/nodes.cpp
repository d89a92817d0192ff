#include "pathtracer/load/gltf/nodes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/trigonometric.hpp>

namespace tandem::pathtracer {
namespace {

/// Nothing, or exactly this many finite numbers.
bool has_numbers(const GltfDocument& document, const std::vector<double>& values, std::size_t count,
                 std::string_view owner, std::string_view property) {
  if (values.empty()) return false;
  if (values.size() != count || !std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
    throw gltf_error(document, owner, fmt::format("its {} are not {} finite numbers", property, count));
  return true;
}

glm::dmat4 local_transform(const GltfDocument& document, const tinygltf::Node& node, std::string_view owner) {
  if (has_numbers(document, node.matrix, 16, owner, "matrix elements")) return glm::make_mat4(node.matrix.data());
  glm::dmat4 transform(1);
  if (has_numbers(document, node.translation, 3, owner, "translations"))
    transform[3] = glm::dvec4(glm::make_vec3(node.translation.data()), 1);
  if (has_numbers(document, node.rotation, 4, owner, "rotations")) {
    const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (!(glm::length(rotation) > 0)) throw gltf_error(document, owner, "its rotation is not a unit quaternion");
    transform *= glm::mat4_cast(glm::normalize(rotation));
  }
  if (has_numbers(document, node.scale, 3, owner, "scales"))
    for (int axis = 0; axis < 3; ++axis) transform[axis] *= node.scale[static_cast<std::size_t>(axis)];
  return transform;
}

std::vector<int> root_nodes(const GltfDocument& document) {
  const tinygltf::Model& model = document.model;
  if (!model.scenes.empty())
    return gltf_at(document, model.scenes, std::max(model.defaultScene, 0), "scene", "the file").nodes;
  std::vector<bool> is_child(model.nodes.size());
  for (const tinygltf::Node& node : model.nodes)
    for (const int child : node.children)
      if (child >= 0 && static_cast<std::size_t>(child) < model.nodes.size())
        is_child[static_cast<std::size_t>(child)] = true;
  std::vector<int> roots;
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  // Where every node is a child they form circles, which the walk over them reports.
  if (roots.empty() && !model.nodes.empty()) roots.push_back(0);
  return roots;
}

glm::dvec3 direction(const GltfDocument& document, const GltfNode& node, glm::dvec3 local) {
  const glm::dvec3 world = glm::dmat3(node.transform) * local;
  const double length = glm::length(world);
  if (!(length > 0) || !std::isfinite(length)) throw gltf_error(document, node.name, "its transform has no direction");
  return world / length;
}

}  // namespace

std::vector<GltfNode> place_gltf_nodes(const GltfDocument& document) {
  struct Pending {
    int index;
    std::string parent;
    glm::dmat4 transform;
  };
  const std::vector<tinygltf::Node>& nodes = document.model.nodes;
  std::vector<Pending> pending;
  const std::vector<int> roots = root_nodes(document);
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) pending.push_back({*root, "the scene", glm::dmat4(1)});
  std::vector<bool> is_placed(nodes.size());
  std::vector<GltfNode> placed;
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    const tinygltf::Node& source = gltf_at(document, nodes, next.index, "node", next.parent);
    const auto index = static_cast<std::size_t>(next.index);
    GltfNode node{.source = &source, .name = gltf_name("node", index, source.name), .transform = {}, .index = index};
    if (is_placed[index]) throw gltf_error(document, node.name, "has two parents, or is its own ancestor");
    is_placed[index] = true;
    node.transform = next.transform * local_transform(document, source, node.name);
    for (auto child = source.children.rbegin(); child != source.children.rend(); ++child)
      pending.push_back({*child, node.name, node.transform});
    placed.push_back(std::move(node));
  }
  return placed;
}

bool is_hidden(const GltfNode& node) { return glm::dmat3(node.transform) == glm::dmat3(0); }

Camera read_gltf_camera(const GltfDocument& document, const GltfNode& node) {
  const int index = node.source->camera;
  const tinygltf::Camera& source = gltf_at(document, document.model.cameras, index, "camera", node.name);
  const std::string name = gltf_name("camera", static_cast<std::size_t>(index), source.name);
  Camera camera;
  const glm::dvec3 position(node.transform[3]);
  const glm::dvec3 view = direction(document, node, {0, 0, -1});
  // So far away that rounding the target does not turn the view.
  const double distance = std::max(1.0, glm::length(position));
  camera.position = glm::vec3(position);
  camera.target = glm::vec3(position + distance * view);
  camera.up = glm::vec3(direction(document, node, {0, 1, 0}));
  if (source.type == "orthographic") {
    camera.kind = CameraKind::orthographic;
    camera.height = static_cast<float>(2 * std::abs(source.orthographic.ymag));
    if (!(camera.height > 0) || !std::isfinite(camera.height))
      throw gltf_error(document, name, fmt::format("a ymag of {} sees nothing", source.orthographic.ymag));
  } else {
    camera.vertical_fov = static_cast<float>(glm::degrees(source.perspective.yfov));
    if (!(camera.vertical_fov > 0 && camera.vertical_fov < 180))
      throw gltf_error(document, name, fmt::format("a yfov of {} is not between 0 and pi", source.perspective.yfov));
  }
  return camera;
}

PunctualLight read_gltf_light(GltfDocument& document, int index, const GltfNode& node) {
  const tinygltf::Light& source = gltf_at(document, document.model.lights, index, "light", node.name);
  const std::string name = gltf_name("light", static_cast<std::size_t>(index), source.name);
  constexpr double unbounded = 1e30;
  PunctualLight light;
  if (source.type == "point") {
    light.kind = LightKind::point;
  } else if (source.type == "spot") {
    light.kind = LightKind::spot;
  } else if (source.type == "directional") {
    light.kind = LightKind::directional;
  } else {
    throw gltf_error(document, name, fmt::format("the type '{}' is not point, spot or directional", source.type));
  }
  light.position = glm::vec3(node.transform[3]);
  light.direction = glm::vec3(direction(document, node, {0, 0, -1}));
  // Blender writes watts times 683 lumens (CIE's definition at 555 nm) and divides by it when it reads; viewers that
  // take the numbers as they are, the Khronos viewer among them, suit files of other origin.
  constexpr double lumens_per_watt = 683;
  const bool by_blender = document.model.asset.generator.find("Blender") != std::string::npos;
  const double unit = by_blender ? lumens_per_watt : 1;
  light.radiance = glm::vec3(gltf_number(document, source.intensity / unit, 0, unbounded, name, "intensity"));
  if (!source.color.empty()) {
    if (source.color.size() != 3) throw gltf_error(document, name, "its color does not have 3 numbers");
    for (int i = 0; i < 3; ++i)
      light.radiance[i] *=
          gltf_number(document, source.color[static_cast<std::size_t>(i)], 0, unbounded, name, "color");
  }
  if (source.range > 0) gltf_warn(document, "lights shine beyond their range");
  if (light.kind != LightKind::spot) return light;
  const double outer = double{
      gltf_number(document, glm::degrees(source.spot.outerConeAngle), 1e-3, 90, name, "outerConeAngle in degrees")};
  const double inner =
      double{gltf_number(document, glm::degrees(source.spot.innerConeAngle), 0, 90, name, "innerConeAngle in degrees")};
  light.outer_angle = static_cast<float>(outer);
  // A light must fade over some angle, though exporters write equal ones for a sharp edge.
  light.inner_angle = static_cast<float>(std::min(inner, 0.999 * outer));
  return light;
}

}  // namespace tandem::pathtracer
