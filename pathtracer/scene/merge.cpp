#include "pathtracer/scene/merge.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/error.hpp"

namespace tandem::pathtracer {
namespace {

/// Where the coordinates of rays and triangles can be multiplied.
constexpr double largest_coordinate = 1e12;

template <typename T>
void append(std::vector<T>& target, std::vector<T>&& source) {
  target.insert(target.end(), std::make_move_iterator(source.begin()), std::make_move_iterator(source.end()));
}

void shift(std::uint32_t& index, std::size_t offset, std::uint32_t none) {
  if (index != none) index += static_cast<std::uint32_t>(offset);
}

void shift_references(GpuMaterial& material, std::size_t textures, std::size_t media) {
  for (std::uint32_t* texture :
       {&material.alpha_texture, &material.base_color_texture, &material.emission_texture,
        &material.reflectance_texture, &material.roughness_texture, &material.metallic_texture,
        &material.transmission_texture, &material.transmittance_texture, &material.specular_texture,
        &material.exponent_texture, &material.normal_texture, &material.bump_texture})
    shift(*texture, textures, no_texture);
  shift(material.medium, media, no_medium);
}

glm::vec3 direction_of(const glm::dmat3& matrix, glm::vec3 direction) {
  const glm::dvec3 result = matrix * glm::dvec3(direction);
  const double length = glm::length(result);
  return length > 0 ? glm::vec3(result / length) : direction;
}

/// From the coordinates of a model, whose 0,0,0 is `from` in its file, to those of a scene, whose is `to`.
struct Placement {
  glm::dmat4 transform;
  glm::dvec3 from;
  glm::dvec3 to;

  glm::vec3 point(glm::vec3 local, const std::string& name) const {
    const glm::dvec3 result(transform * glm::dvec4(glm::dvec3(local) + from, 1.0));
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(result[axis]) <= largest_coordinate))
        throw Error(fmt::format("{}: its transform leads beyond {:g}", name, largest_coordinate));
    return glm::vec3(result - to);
  }
};

/// The factor by which a similarity scales, or nothing for a map that is none.
std::optional<double> similarity_scale(const glm::dmat3& linear) {
  const double scale = std::cbrt(std::abs(glm::determinant(linear)));
  constexpr double rounding = 1e-6;  // of matrices that were written with floats
  const glm::dmat3 product = glm::transpose(linear) * linear;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::abs(product[i][j] - (i == j ? scale * scale : 0.0)) > rounding * scale * scale) return std::nullopt;
  return scale;
}

void transform_geometry(Scene& model, const Placement& placement) {
  const glm::dmat3 linear(placement.transform);
  const glm::dmat3 for_normals = glm::transpose(glm::inverse(linear));
  for (glm::vec3& position : model.positions) position = placement.point(position, model.name);
  for (glm::vec3& normal : model.normals) normal = direction_of(for_normals, normal);
  const float handedness = glm::determinant(linear) < 0 ? -1.0f : 1.0f;
  for (GpuVertexAttributes& vertex : model.attributes)
    vertex.tangent = glm::vec4(direction_of(linear, glm::vec3(vertex.tangent)), vertex.tangent.w * handedness);
  if (glm::determinant(linear) < 0)
    for (GpuTriangle& triangle : model.triangles) std::swap(triangle.vertices[1], triangle.vertices[2]);
  if (model.spheres.empty()) return;
  const std::optional<double> scale = similarity_scale(linear);
  if (!scale) throw Error(fmt::format("{}: its transform would deform its spheres", model.name));
  for (GpuSphere& sphere : model.spheres) {
    sphere.centre = placement.point(sphere.centre, model.name);
    sphere.radius *= static_cast<float>(*scale);
    sphere.motion = glm::vec3(linear * glm::dvec3(sphere.motion));
  }
}

void transform_views(Scene& model, const Placement& placement) {
  const glm::dmat3 linear(placement.transform);
  for (PunctualLight& light : model.lights) {
    light.position = placement.point(light.position, model.name);
    light.direction = direction_of(linear, light.direction);
  }
  if (!model.camera) return;
  Camera& camera = *model.camera;
  camera.position = placement.point(camera.position, model.name);
  camera.target = placement.point(camera.target, model.name);
  camera.up = direction_of(linear, camera.up);
  camera.motion = glm::vec3(linear * glm::dvec3(camera.motion));
  const float scale = static_cast<float>(std::cbrt(std::abs(glm::determinant(linear))));
  camera.height *= scale;
  camera.lens_radius *= scale;
  camera.focus_distance *= scale;
}

}  // namespace

void append(Scene& scene, Scene model, const glm::dmat4& transform) {
  if (transform != glm::dmat4(1.0) || model.origin != scene.origin) {
    const Placement placement{transform, model.origin, scene.origin};
    transform_geometry(model, placement);
    transform_views(model, placement);
  }
  const std::size_t materials = scene.materials.size();
  for (GpuMaterial& material : model.materials) shift_references(material, scene.textures.size(), scene.media.size());
  for (GpuTriangle& triangle : model.triangles) {
    for (std::uint32_t& vertex : triangle.vertices) vertex += static_cast<std::uint32_t>(scene.positions.size());
    triangle.material += static_cast<std::uint32_t>(materials);  // its bit for smooth triangles stays
  }
  for (GpuSphere& sphere : model.spheres) sphere.material += static_cast<std::uint32_t>(materials);
  for (Texture& texture : model.textures) texture.image += static_cast<std::uint32_t>(scene.images.size());
  if (model.environment) shift(model.environment->texture, scene.textures.size(), no_texture);
  shift(model.medium, scene.media.size(), no_medium);

  if (scene.texture_coordinates.empty() != model.texture_coordinates.empty()) {
    scene.texture_coordinates.resize(scene.positions.size(), glm::vec2(0));
    model.texture_coordinates.resize(model.positions.size(), glm::vec2(0));
  }
  if (scene.attributes.empty() != model.attributes.empty()) {
    scene.attributes.resize(scene.positions.size());
    model.attributes.resize(model.positions.size());
  }
  append(scene.positions, std::move(model.positions));
  append(scene.normals, std::move(model.normals));
  append(scene.texture_coordinates, std::move(model.texture_coordinates));
  append(scene.attributes, std::move(model.attributes));
  append(scene.triangles, std::move(model.triangles));
  append(scene.spheres, std::move(model.spheres));
  append(scene.materials, std::move(model.materials));
  append(scene.material_names, std::move(model.material_names));
  append(scene.images, std::move(model.images));
  append(scene.textures, std::move(model.textures));
  append(scene.lights, std::move(model.lights));
  append(scene.media, std::move(model.media));
  append(scene.warnings, std::move(model.warnings));
  if (!scene.camera) scene.camera = model.camera;
  if (!scene.environment) scene.environment = model.environment;
  if (scene.medium == no_medium) scene.medium = model.medium;
}

}  // namespace tandem::pathtracer
