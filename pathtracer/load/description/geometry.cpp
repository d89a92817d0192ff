#include "pathtracer/load/description/geometry.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include "pathtracer/load/access/file_access.hpp"
#include "pathtracer/load/description/transform.hpp"
#include "pathtracer/scene/merge.hpp"

namespace tandem::pathtracer::description {
namespace {

std::vector<Value> elements_of(const std::optional<Value>& list) {
  return list ? list->elements() : std::vector<Value>();
}

/// Far from 0 numbers count as they are written; elsewhere as the floats that they always were.
glm::dmat4 transform_of(const Object& object, const Scene& scene) {
  const std::optional<Value> transform = object.get("transform");
  return transform ? read_transform(*transform, scene.origin != glm::dvec3(0)) : glm::dmat4(1.0);
}

/// "it has: a, b and 7 more"
std::string known(const std::multimap<std::string_view, std::size_t>& named) {
  constexpr std::size_t shown = 10;
  std::vector<std::string> names;
  for (const auto& [name, index] : named)
    if (names.size() < shown) names.push_back(shortened(name));
  const std::string more = named.size() > shown ? fmt::format(" and {} more", named.size() - shown) : std::string();
  return fmt::format("it has: {}{}", fmt::join(names, ", "), more);
}

/// What the model does without in the description's favour: materials of its own that have been given another.
void override_materials(const Value& overrides, const NamedIndices& materials, std::size_t first, Scene& scene) {
  std::multimap<std::string_view, std::size_t> named;
  for (std::size_t i = first; i < scene.materials.size(); ++i) named.emplace(scene.material_names[i], i);
  for (const auto& [name, value] : overrides.members()) {
    const std::uint32_t replacement = materials.find(value);
    const auto [begin, end] = named.equal_range(name);
    if (begin == end) value.fail(fmt::format("stands for a material that the model does not have; {}", known(named)));
    for (auto entry = begin; entry != end; ++entry) scene.materials[entry->second] = scene.materials[replacement];
  }
}

/// A quadrilateral of its own four vertices.
void add_quadrilateral(Scene& scene, const std::array<glm::vec3, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), corners.begin(), corners.end());
  scene.normals.insert(scene.normals.end(), corners.size(), glm::vec3(0, 0, 1));
  for (const glm::vec2 coordinates : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)})
    scene.texture_coordinates.push_back(coordinates);
  scene.triangles.push_back({.vertices = {first, first + 1, first + 2}, .material = 0});
  scene.triangles.push_back({.vertices = {first, first + 2, first + 3}, .material = 0});
}

/// Adds a model without materials, all of it of one material of the scene.
void place(const Value& value, Scene model, const glm::dmat4& transform, std::uint32_t material, Scene& scene) {
  const std::size_t first = scene.triangles.size();
  try {
    append(scene, std::move(model), transform);
  } catch (const Error& error) {
    value.fail(fmt::format("cannot be placed: {}", error.what()));
  }
  for (std::size_t i = first; i < scene.triangles.size(); ++i) scene.triangles[i].material = material;
}

}  // namespace

glm::vec3 read_point(const Value& value, const Scene& scene) {
  return glm::vec3(value.double_vector(any_length) - scene.origin);
}

void add_models(const std::optional<Value>& list, const std::filesystem::path& folder, const LoadOptions& options,
                const ModelLoader& load_model, const NamedIndices& materials, Scene& scene) {
  std::map<std::filesystem::path, Scene> loaded;  // a file that is placed twice is read once
  for (const Value& value : elements_of(list)) {
    const Object object(value, {"file", "transform", "materials"});
    const Value file = object.require("file");
    const std::filesystem::path path = folder / file.text();
    if (!may_read(path, options)) file.fail(fmt::format("cannot be read: {}", outside_sentence(path)));
    if (path.extension() == ".json") file.fail("must be a model, not another description");
    const glm::dmat4 transform = transform_of(object, scene);
    if (!loaded.contains(path)) {
      loaded.emplace(path, load_model(path));
      scene.warnings.insert(scene.warnings.end(), loaded[path].warnings.begin(), loaded[path].warnings.end());
      loaded[path].warnings.clear();
    }
    const std::size_t first_material = scene.materials.size();
    append(scene, loaded[path], transform);
    if (const std::optional<Value> overrides = object.get("materials"))
      override_materials(*overrides, materials, first_material, scene);
  }
}

void add_spheres(const std::optional<Value>& list, const NamedIndices& materials, Scene& scene) {
  for (const Value& value : elements_of(list)) {
    const Object object(value, {"centre", "radius", "motion", "material"});
    GpuSphere sphere;
    sphere.centre = read_point(object.require("centre"), scene);
    sphere.radius = object.require("radius").number(positive_length);
    object.read("motion", sphere.motion, &Value::vector, any_length);
    sphere.material = materials.find(object.require("material"));
    scene.spheres.push_back(sphere);
  }
}

void add_boxes(const std::optional<Value>& list, const NamedIndices& materials, Scene& scene) {
  for (const Value& value : elements_of(list)) {
    const Object object(value, {"minimum", "maximum", "transform", "material"});
    const glm::dvec3 minimum = object.require("minimum").double_vector(any_length);
    const glm::dvec3 maximum = object.require("maximum").double_vector(any_length);
    Scene box;
    if (scene.origin != glm::dvec3(0)) box.origin = minimum;
    const glm::vec3 low(minimum - box.origin);
    const glm::vec3 high(maximum - box.origin);
    for (int axis = 0; axis < 3; ++axis)
      if (!(minimum[axis] < maximum[axis])) value.fail("must have a maximum above its minimum along every axis");
    const auto corner = [&](int index) {
      return glm::vec3((index & 1) != 0 ? high.x : low.x, (index & 2) != 0 ? high.y : low.y,
                       (index & 4) != 0 ? high.z : low.z);
    };
    // Each face counter-clockwise seen from outside, upright where it stands.
    constexpr std::array<std::array<int, 4>, 6> faces = {
        {{4, 5, 7, 6}, {1, 0, 2, 3}, {5, 1, 3, 7}, {0, 4, 6, 2}, {6, 7, 3, 2}, {0, 1, 5, 4}}};
    for (const auto& [a, b, c, d] : faces) add_quadrilateral(box, {corner(a), corner(b), corner(c), corner(d)});
    place(value, std::move(box), transform_of(object, scene), materials.find(object.require("material")), scene);
  }
}

void add_quads(const std::optional<Value>& list, const NamedIndices& materials, Scene& scene) {
  for (const Value& value : elements_of(list)) {
    const Object object(value, {"corner", "u", "v", "material"});
    const glm::vec3 corner = read_point(object.require("corner"), scene);
    const glm::vec3 u = object.require("u").vector(any_length);
    const glm::vec3 v = object.require("v").vector(any_length);
    add_parallelogram(value, corner, u, v, materials.find(object.require("material")), scene);
  }
}

void add_parallelogram(const Value& value, glm::vec3 corner, glm::vec3 u, glm::vec3 v, std::uint32_t material,
                       Scene& scene) {
  if (glm::length(glm::cross(glm::dvec3(u), glm::dvec3(v))) == 0)
    value.fail("must have sides u and v that span an area");
  Scene quad;
  quad.origin = scene.origin;
  add_quadrilateral(quad, {corner, corner + u, corner + u + v, corner + v});
  place(value, std::move(quad), glm::dmat4(1.0), material, scene);
}

}  // namespace tandem::pathtracer::description
