#include "compare/probe/instance_setup.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace tandem::compare {
namespace {

/// A turn by `angle` about a unit axis (Rodrigues' formula).
glm::dmat3 rotation(const glm::dvec3& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  glm::dmat3 matrix;
  for (int column = 0; column < 3; ++column) {
    glm::dvec3 unit(0);
    unit[column] = 1;
    matrix[column] = c * unit + s * glm::cross(axis, unit) + (1 - c) * axis[column] * axis;
  }
  return matrix;
}

glm::dmat3 scaling(double x, double y, double z) {
  return glm::dmat3(glm::dvec3(x, 0, 0), glm::dvec3(0, y, 0), glm::dvec3(0, 0, z));
}

/// What applies `linear` about `centre`, then moves.
Transform about(const glm::dvec3& centre, const glm::dmat3& linear, const glm::dvec3& move) {
  const glm::dvec3 translation = centre + move - linear * centre;
  Transform transform;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      transform[static_cast<std::size_t>(4 * row + column)] = static_cast<float>(linear[column][row]);
    transform[static_cast<std::size_t>(4 * row + 3)] = static_cast<float>(translation[row]);
  }
  return transform;
}

}  // namespace

std::vector<Placement> placements(InstanceSetup instance_setup, const pathtracer::Scene& scene) {
  const pathtracer::Bounds bounds = pathtracer::bounds(scene);
  const glm::dvec3 centre(bounds.centre());
  double radius = 0.5 * glm::length(glm::dvec3(bounds.extent()));
  if (!(radius > 0)) radius = 1;
  // No copy is larger than 1.5 times the scene, so they do not meet.
  const double apart = 5 * radius;
  const glm::dvec3 places[] = {{0, 0, 0}, {apart, 0, 0}, {0, apart, 0}, {0, 0, apart}};
  const glm::dmat3 unmoved(1.0);
  const glm::dmat3 turn = rotation(glm::normalize(glm::dvec3(1, 2, 3)), 0.7);
  const glm::dmat3 other_turn = rotation(glm::normalize(glm::dvec3(3, -1, 1)), 1.1);
  const glm::dmat3 mirror = turn * scaling(-1, 1, 1);

  if (instance_setup == InstanceSetup::instances)
    return {{.mask = 0x01},
            {.transform = about(centre, turn, places[1]), .mask = 0x80},
            {.transform = about(centre, mirror, places[2]), .mask = 0x10},
            {.transform = about(centre, turn * scaling(0.6, 1.5, 1.1) * other_turn, places[3]), .mask = 0x0c}};
  if (instance_setup == InstanceSetup::instance_flags)
    return {{.flags = rhi::InstanceFlags::triangle_flip_facing},
            {.transform = about(centre, unmoved, places[1]), .flags = rhi::InstanceFlags::triangle_facing_cull_disable},
            {.transform = about(centre, unmoved, places[2]), .flags = rhi::InstanceFlags::force_opaque},
            {.transform = about(centre, unmoved, places[3]), .flags = rhi::InstanceFlags::force_no_opaque}};
  if (is_transformed_at_build(instance_setup)) return {{.transform = about(centre, mirror, glm::dvec3(0.5 * radius))}};
  return {Placement{}};
}

std::uint32_t custom_index(std::uint32_t placement, bool spheres) {
  return 0xa5c300u + 16 * placement + (spheres ? 9 : 5);
}

std::uint32_t hit_record(std::uint32_t placement, bool spheres) { return 2 * (placement % 2) + (spheres ? 1 : 0); }

}  // namespace tandem::compare
