#include "pathtracer/scene/scene.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tandem::pathtracer {

Bounds bounds(const Scene& scene) {
  Bounds box{glm::vec3(std::numeric_limits<float>::max()), glm::vec3(std::numeric_limits<float>::lowest())};
  for (const GpuTriangle& triangle : scene.triangles)
    for (const std::uint32_t vertex : triangle.vertices) {
      box.minimum = glm::min(box.minimum, scene.positions[vertex]);
      box.maximum = glm::max(box.maximum, scene.positions[vertex]);
    }
  for (const GpuSphere& sphere : scene.spheres)
    for (const glm::vec3 centre : {sphere.centre, sphere.centre + sphere.motion}) {
      box.minimum = glm::min(box.minimum, centre - sphere.radius);
      box.maximum = glm::max(box.maximum, centre + sphere.radius);
    }
  return box;
}

double triangle_area(const Scene& scene, const GpuTriangle& triangle) {
  const glm::dvec3 a(scene.positions[triangle.vertices[0]]);
  const glm::dvec3 b(scene.positions[triangle.vertices[1]]);
  const glm::dvec3 c(scene.positions[triangle.vertices[2]]);
  return 0.5 * glm::length(glm::cross(b - a, c - a));
}

GpuMaterial diffuse_material(glm::vec3 albedo, glm::vec3 emission) {
  GpuMaterial material;
  material.base_color = albedo;
  material.emission = emission;
  return material;
}

std::uint32_t add_texture(Scene& scene, TextureImage image) {
  scene.textures.push_back({.gpu = {}, .image = static_cast<std::uint32_t>(scene.images.size())});
  scene.images.push_back(std::move(image));
  return static_cast<std::uint32_t>(scene.textures.size() - 1);
}

bool has_texture(const GpuMaterial& material) {
  const std::uint32_t textures[] = {
      material.base_color_texture,    material.emission_texture, material.reflectance_texture,
      material.roughness_texture,     material.metallic_texture, material.transmission_texture,
      material.transmittance_texture, material.specular_texture, material.exponent_texture,
      material.normal_texture,        material.bump_texture,     material.alpha_texture};
  return std::ranges::any_of(textures, [](std::uint32_t texture) { return texture != no_texture; });
}

bool is_transparent(const GpuMaterial& material) {
  return material.opacity < 1 || material.alpha_texture != no_texture ||
         (material.attributes & vertex_attribute::opacity) != 0;
}

bool is_transparent(const Scene& scene, const GpuTriangle& triangle) {
  return is_transparent(scene.materials[triangle.material & ~triangle_smooth]);
}

}  // namespace tandem::pathtracer
