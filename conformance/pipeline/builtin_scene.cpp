#include "conformance/pipeline/builtin_scene.hpp"

#include <array>
#include <glm/matrix.hpp>

namespace tandem::conformance::pipeline {
namespace {

constexpr std::array<std::uint32_t, 2> primitive_counts = {2, 3};

/// Where a primitive is in the object's x: two units apart, so that a ray meets one at most.
float place_of(std::uint32_t geometry, std::uint32_t primitive) {
  return static_cast<float>(2 * (geometry * primitive_counts[0] + primitive));
}

constexpr std::array<Transform, 3> transforms = {
    identity,
    // Rotated by some 30 degrees about y, scaled differently along each axis, sheared, and moved far from the others.
    Transform{1.75F, 0.25F, 1.0F, 40.0F, 0.125F, 0.5F, -0.0625F, -3.0F, -1.0F, 0.375F, 1.5F, 7.0F},
    Transform{-1.0F, 0.0F, 0.0F, -20.0F, 0.0F, 1.0F, 0.0F, 5.0F, 0.0F, 0.0F, 1.0F, -2.0F},
};
constexpr std::array<std::uint32_t, 3> custom_indices = {0, 0xFFFFFF, 0x123456};

glm::dmat3 linear_part(const Transform& transform) {
  glm::dmat3 matrix;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      matrix[column][row] = static_cast<double>(transform[static_cast<std::size_t>(row * 4 + column)]);
  return matrix;
}

/// The ray that is meant to hit primitive `place` from the front or back, and what it really hits once its numbers are
/// rounded to floats.
ExpectedHit expected_hit(std::uint32_t instance, std::uint32_t geometry, std::uint32_t primitive) {
  ExpectedHit hit;
  hit.instance = instance;
  hit.custom_index = custom_indices[instance];
  hit.geometry = geometry;
  hit.primitive = primitive;
  hit.object_to_world = transforms[instance];
  const glm::dmat3 linear = linear_part(hit.object_to_world);
  hit.world_to_object_linear = glm::inverse(linear);
  hit.translation = glm::dvec3(static_cast<double>(hit.object_to_world[3]), static_cast<double>(hit.object_to_world[7]),
                               static_cast<double>(hit.object_to_world[11]));

  const double place = static_cast<double>(place_of(geometry, primitive));
  const bool from_above = (instance + geometry + primitive) % 2 == 0;
  const glm::dvec3 target(place + 0.25 + 0.0625 * static_cast<double>(primitive), 0.5, 0.0);
  const glm::dvec3 direction(0.02 * static_cast<double>(primitive), -0.03, from_above ? -1.5 : 1.5);
  const double intended_t = 3.0 + 0.5 * static_cast<double>(geometry);
  hit.ray.origin = glm::vec3(linear * (target - direction * intended_t) + hit.translation);
  hit.ray.direction = glm::vec3(linear * direction);
  hit.ray.t_min = 0.125F * static_cast<float>(1 + primitive);
  hit.ray.t_max = 8.0F + static_cast<float>(instance);

  hit.object_origin = hit.world_to_object_linear * (glm::dvec3(hit.ray.origin) - hit.translation);
  hit.object_direction = hit.world_to_object_linear * glm::dvec3(hit.ray.direction);
  hit.t = -hit.object_origin.z / hit.object_direction.z;
  const glm::dvec3 point = hit.object_origin + hit.object_direction * hit.t;
  hit.barycentrics = glm::dvec2(point.x - place, point.y);
  // Front: (v1 - v0) x (v2 - v0), which is +z, points against the ray.
  hit.front_face = from_above;
  return hit;
}

}  // namespace

BuiltinScene builtin_scene(rhi::Device& device, PrimitiveKind kind, rhi::GeometryFlags flags) {
  BuiltinScene result;
  std::vector<rhi::Geometry> geometries;
  for (std::uint32_t geometry = 0; geometry < primitive_counts.size(); ++geometry) {
    std::vector<glm::vec3> vertices;
    std::vector<Box> box_list;
    for (std::uint32_t primitive = 0; primitive < primitive_counts[geometry]; ++primitive) {
      const glm::vec3 place(place_of(geometry, primitive), 0, 0);
      for (const glm::vec3& vertex : triangle_at(place)) vertices.push_back(vertex);
      box_list.push_back({.minimum = place - glm::vec3(0, 0, 0.5F), .maximum = place + glm::vec3(1, 1, 0.5F)});
    }
    if (kind == PrimitiveKind::triangles)
      geometries.emplace_back(triangles(device, vertices, flags));
    else
      geometries.emplace_back(boxes(device, box_list, flags));
  }
  result.scene.bottom_level = build_bottom_level(device, std::move(geometries));
  std::vector<rhi::InstanceDesc> instances;
  for (std::uint32_t instance = 0; instance < transforms.size(); ++instance) {
    instances.push_back(rhi::make_instance(*result.scene.bottom_level, transforms[instance]));
    instances.back().custom_index = custom_indices[instance] & 0xFFFFFF;
    for (std::uint32_t geometry = 0; geometry < primitive_counts.size(); ++geometry)
      for (std::uint32_t primitive = 0; primitive < primitive_counts[geometry]; ++primitive)
        result.hits.push_back(expected_hit(instance, geometry, primitive));
  }
  for (ExpectedHit& hit : result.hits) hit.launch_size = static_cast<std::uint32_t>(result.hits.size());
  result.scene.top_level = build_top_level(device, instances);
  return result;
}

std::vector<TracedRay> rays_of(const BuiltinScene& scene) {
  std::vector<TracedRay> rays;
  for (const ExpectedHit& hit : scene.hits) rays.push_back(hit.ray);
  return rays;
}

}  // namespace tandem::conformance::pipeline
