#include "compare/study/study_scenes.hpp"

#include <array>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace tandem::study {
namespace {

using pathtracer::GpuMaterial;
using pathtracer::Scene;

std::uint32_t add_material(Scene& scene, const std::string& name, const GpuMaterial& material) {
  scene.materials.push_back(material);
  scene.material_names.push_back(name);
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

std::uint32_t add_vertex(Scene& scene, const glm::vec3& position, const glm::vec3& normal) {
  scene.positions.push_back(position);
  scene.normals.push_back(normal);
  return static_cast<std::uint32_t>(scene.positions.size() - 1);
}

/// corner, corner + u, corner + u + v, corner + v; seen counter-clockwise from u x v.
void add_quad(Scene& scene, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v, std::uint32_t material) {
  const glm::vec3 normal = glm::normalize(glm::cross(u, v));
  const std::array corners = {add_vertex(scene, corner, normal), add_vertex(scene, corner + u, normal),
                              add_vertex(scene, corner + u + v, normal), add_vertex(scene, corner + v, normal)};
  scene.triangles.push_back({.vertices = {corners[0], corners[1], corners[2]}, .material = material});
  scene.triangles.push_back({.vertices = {corners[0], corners[2], corners[3]}, .material = material});
}

/// A block on the floor without a bottom: from the origin to `size`, turned about the y axis, then moved.
void add_block(Scene& scene, const glm::vec3& size, float degrees, const glm::vec3& offset, std::uint32_t material) {
  const float cosine = std::cos(glm::radians(degrees)), sine = std::sin(glm::radians(degrees));
  const glm::vec3 x = size.x * glm::vec3(cosine, 0, -sine);
  const glm::vec3 y = glm::vec3(0, size.y, 0);
  const glm::vec3 z = size.z * glm::vec3(sine, 0, cosine);
  add_quad(scene, offset, y, x, material);
  add_quad(scene, offset + z, x, y, material);
  add_quad(scene, offset, z, y, material);
  add_quad(scene, offset + x, y, z, material);
  add_quad(scene, offset + y, z, x, material);
}

/// A rough metal that reflects all colours alike. @param alpha of GGX
GpuMaterial polished(float alpha) {
  GpuMaterial material;
  material.model = pathtracer::MaterialModel::conductor;
  material.base_color = glm::vec3(0);
  material.reflectance = glm::vec3(0.6f);
  material.roughness = std::sqrt(alpha);
  return material;
}

}  // namespace

Scene weekend_box() {
  Scene scene;
  scene.name = "weekend box";
  const std::uint32_t white = add_material(scene, "white", pathtracer::diffuse_material(glm::vec3(0.73f)));
  const std::uint32_t red = add_material(scene, "red", pathtracer::diffuse_material({0.65f, 0.05f, 0.05f}));
  const std::uint32_t green = add_material(scene, "green", pathtracer::diffuse_material({0.12f, 0.45f, 0.15f}));
  const std::uint32_t light = add_material(scene, "light", pathtracer::diffuse_material(glm::vec3(0), glm::vec3(15)));
  const glm::vec3 x(555, 0, 0), y(0, 555, 0), z(0, 0, 555), origin(0);
  add_quad(scene, x, z, y, green);
  add_quad(scene, origin, y, z, red);
  add_quad(scene, origin, z, x, white);
  add_quad(scene, y, x, z, white);
  add_quad(scene, z, y, x, white);
  add_quad(scene, {213, 554, 227}, {130, 0, 0}, {0, 0, 105}, light);
  add_block(scene, {165, 330, 165}, 15, {265, 0, 295}, white);
  add_block(scene, {165, 165, 165}, -18, {130, 0, 65}, white);
  scene.camera = {.position = {278, 278, -800}, .target = {278, 278, 0}, .vertical_fov = 40};
  return scene;
}

Scene veach_plates() {
  Scene scene;
  scene.name = "Veach's plates";
  const glm::vec3 eye(0, 2, 15);
  scene.camera = {.position = eye, .target = {0, -0.5f, 2}, .vertical_fov = 38};
  const std::uint32_t grey = add_material(scene, "grey", pathtracer::diffuse_material(glm::vec3(0.3f)));
  add_quad(scene, {-15, -4, 12}, {30, 0, 0}, {0, 0, -16}, grey);
  add_quad(scene, {-15, -4, -4}, {30, 0, 0}, {0, 14, 0}, grey);

  const float light_height = 4;
  for (const float radius : {0.03f, 0.1f, 0.3f, 0.9f}) {
    const std::uint32_t light =
        add_material(scene, "light", pathtracer::diffuse_material(glm::vec3(0), glm::vec3(1.5f / (radius * radius))));
    const float x = -3.75f + 2.5f * static_cast<float>(scene.spheres.size());
    scene.spheres.push_back({.centre = {x, light_height, 0}, .radius = radius, .material = light});
  }
  const std::array centres = {glm::vec3(0, -1.2f, 0.5f), glm::vec3(0, -2.1f, 2.2f), glm::vec3(0, -2.8f, 4.2f),
                              glm::vec3(0, -3.2f, 6.2f)};
  const std::array alphas = {0.005f, 0.02f, 0.06f, 0.15f};
  for (std::size_t i = 0; i < centres.size(); ++i) {
    // Tilted so that its middle mirrors the row of lights into the camera.
    const glm::vec3 centre = centres[i];
    const glm::vec3 normal =
        glm::normalize(glm::normalize(eye - centre) + glm::normalize(glm::vec3(0, light_height, 0) - centre));
    const glm::vec3 across(8, 0, 0);
    const glm::vec3 along = 1.5f * glm::normalize(glm::cross(normal, across));
    const std::uint32_t metal = add_material(scene, "plate", polished(alphas[i]));
    add_quad(scene, centre - 0.5f * (across + along), across, along, metal);
  }
  return scene;
}

Scene light_over_floor() {
  Scene scene;
  scene.name = "light over floor";
  const std::uint32_t grey = add_material(scene, "grey", pathtracer::diffuse_material(glm::vec3(0.5f)));
  const std::uint32_t light = add_material(scene, "light", pathtracer::diffuse_material(glm::vec3(0), glm::vec3(10)));
  add_quad(scene, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20}, grey);
  const glm::vec3 down(0, -1, 0);
  const std::uint32_t first = add_vertex(scene, {-1, 3, -1}, down);
  add_vertex(scene, {1, 3, -1}, down);
  add_vertex(scene, {0, 3, 1}, down);
  scene.triangles.push_back({.vertices = {first, first + 1, first + 2}, .material = light});
  scene.camera = {.position = {0, 2, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}, .vertical_fov = 60};
  return scene;
}

}  // namespace tandem::study
