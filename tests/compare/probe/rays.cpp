#include "tests/compare/probe/rays.hpp"

#include <random>

#include <glm/geometric.hpp>

namespace tandem::test {
namespace {

using Random = std::mt19937;

float uniform(Random& random) { return static_cast<float>(random() >> 8) * 0x1p-24f; }

glm::vec3 uniform_vector(Random& random) {
  const float x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

glm::vec3 point_on_surface(const pathtracer::Scene& scene, Random& random) {
  const std::size_t index = random() % (scene.triangles.size() + scene.spheres.size());
  if (index < scene.triangles.size()) {
    const auto corner = [&](int i) { return scene.positions[scene.triangles[index].vertices[i]]; };
    float u = uniform(random), v = uniform(random);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    return corner(0) + u * (corner(1) - corner(0)) + v * (corner(2) - corner(0));
  }
  const pathtracer::GpuSphere& sphere = scene.spheres[index - scene.triangles.size()];
  const glm::vec3 direction = 2.0f * uniform_vector(random) - 1.0f;
  return sphere.centre + sphere.radius * glm::normalize(direction + glm::vec3(0, 1e-3f, 0));
}

}  // namespace

std::vector<compare::PathRay> rays_through(const pathtracer::Scene& scene, std::size_t count, std::uint32_t seed) {
  Random random(seed);
  const pathtracer::Bounds bounds = pathtracer::bounds(scene);
  std::vector<compare::PathRay> rays;
  for (std::uint32_t i = 0; rays.size() < count; ++i) {
    const glm::vec3 anywhere = bounds.centre() + 1.5f * bounds.extent() * (uniform_vector(random) - 0.5f);
    const glm::vec3 origin = i % 3 == 0 ? point_on_surface(scene, random) : anywhere;
    const glm::vec3 direction = (0.25f + uniform(random)) * (point_on_surface(scene, random) - origin);
    compare::PathRay ray;
    ray.path.pixel = {i, 0};
    // Off the surface, or whether the ray meets it again would be anyone's guess.
    ray.ray.origin = origin + 0.01f * direction;
    ray.ray.direction = direction;
    ray.ray.t_max = i % 5 == 0 ? 1.5f : 1e30f;
    if (compare::is_askable(ray.ray)) rays.push_back(ray);
  }
  return rays;
}

pathtracer::Scene soup(std::size_t triangle_count, std::size_t sphere_count, std::uint32_t seed) {
  Random random(seed);
  pathtracer::Scene scene;
  scene.name = "soup";
  scene.materials = {pathtracer::diffuse_material(glm::vec3(0.5f))};
  scene.material_names = {"grey"};
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const glm::vec3 place = uniform_vector(random);
    const float size = i % 4 == 0 ? 1.0f : (i % 4 == 1 ? 0.02f : 0.2f);
    const glm::vec3 first = uniform_vector(random) - 0.5f, second = uniform_vector(random) - 0.5f;
    scene.positions.push_back(place);
    scene.positions.push_back(place + size * first);
    // Every 16th has no area, every 8th is a sliver.
    scene.positions.push_back(place +
                              size * (i % 16 == 0 ? 2.0f * first : (i % 8 == 1 ? first + 0.01f * second : second)));
    scene.triangles.push_back({.vertices = {3 * i, 3 * i + 1, 3 * i + 2}, .material = 0});
  }
  scene.normals.resize(scene.positions.size(), glm::vec3(0, 0, 1));
  for (std::size_t i = 0; i < sphere_count; ++i) {
    pathtracer::GpuSphere sphere;
    sphere.centre = uniform_vector(random);
    sphere.radius = 0.02f + 0.1f * uniform(random);
    scene.spheres.push_back(sphere);
  }
  return scene;
}

}  // namespace tandem::test
