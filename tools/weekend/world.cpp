#include "tools/weekend/world.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "tools/weekend/bvh.hpp"
#include "tools/weekend/models.hpp"
#include "tools/weekend/shapes.hpp"

namespace tandem::weekend {
namespace {

/// Of the size of the scene. Double precision errs by a hundred-millionth of it; shadows of anything that is larger
/// than it stay.
constexpr double nearest_part = 1e-8;

bool has_any_texture(const pathtracer::GpuMaterial& material) {
  return pathtracer::has_texture(material) || material.alpha_texture != pathtracer::no_texture;
}

glm::dvec3 background_of(const pathtracer::Scene& scene, bool has_lights) {
  if (scene.settings.background) return *scene.settings.background;
  if (scene.environment) return scene.environment->radiance;
  return glm::dvec3(has_lights ? 0 : 1);
}

}  // namespace

World make_world(const pathtracer::Scene& scene) {
  const auto refuse = [&](const char* what) {
    throw Error(fmt::format("{}: the baseline has no {}", scene.name, what));
  };
  if (!scene.media.empty() || scene.medium != pathtracer::no_medium) refuse("media");
  if (scene.environment && scene.environment->texture != pathtracer::no_texture) refuse("environment maps");
  World world;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    world.materials.push_back(make_material(scene, i));
  }

  std::vector<std::shared_ptr<const Hittable>> objects;
  const auto add = [&](std::shared_ptr<const Hittable> object, const Material* material) {
    if (material->emits()) world.lights.push_back(object);
    objects.push_back(std::move(object));
  };
  for (const pathtracer::GpuTriangle& triangle : scene.triangles) {
    // A triangle without an area is met by nothing, and no light that could be sampled.
    if (!(pathtracer::triangle_area(scene, triangle) > 0)) continue;
    std::array<Corner, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t vertex = triangle.vertices[i];
      corners[i].position = scene.positions[vertex];
      corners[i].normal = scene.normals[vertex];
      if (!scene.texture_coordinates.empty()) corners[i].uv = scene.texture_coordinates[vertex];
    }
    const Material* const material = world.materials[triangle.material & ~pathtracer::triangle_smooth].get();
    const bool smooth = (triangle.material & pathtracer::triangle_smooth) != 0;
    add(std::make_shared<Triangle>(corners, smooth, material), material);
  }
  for (const pathtracer::GpuSphere& sphere : scene.spheres) {
    if (sphere.motion != glm::vec3(0)) refuse("moving spheres");
    if (has_any_texture(scene.materials[sphere.material])) refuse("textures on spheres");
    const Material* const material = world.materials[sphere.material].get();
    add(std::make_shared<Sphere>(sphere.centre, sphere.radius, material), material);
  }
  if (objects.empty()) refuse("surface to show in this scene");
  world.objects = std::make_shared<BvhNode>(objects);
  const Box box = world.objects->bounds();
  world.nearest = nearest_part * glm::length(box.maximum - box.minimum);
  world.punctual = scene.lights;
  world.background = background_of(scene, !world.lights.empty() || !world.punctual.empty());
  return world;
}

}  // namespace tandem::weekend
