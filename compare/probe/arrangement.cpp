#include "compare/probe/arrangement.hpp"

#include <algorithm>
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

Transform transform_of(const glm::dmat3& linear, const glm::dvec3& translation) {
  Transform transform;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      transform[static_cast<std::size_t>(4 * row + column)] = static_cast<float>(linear[column][row]);
    transform[static_cast<std::size_t>(4 * row + 3)] = static_cast<float>(translation[row]);
  }
  return transform;
}

}  // namespace

std::vector<Placement> placements(Arrangement arrangement, const pathtracer::Scene& scene) {
  // No farther than 1: drivers invert these matrices in single precision, and the farther, the worse (Mesa's
  // util_invert_mat4x4 eliminates with the translation as its pivot).
  const double radius = 0.5 * glm::length(glm::dvec3(pathtracer::bounds(scene).extent()));
  const glm::dvec3 move = (radius > 0 ? std::min(radius, 1.0) : 1.0) * glm::dvec3(0.5, -0.25, 0.75);
  const glm::dmat3 turn = rotation(glm::normalize(glm::dvec3(1, 2, 3)), 0.7);
  const glm::dmat3 mirror = turn * scaling(-1, 1, 1);
  const glm::dmat3 shear = turn * scaling(0.6, 1.5, 1.1) * rotation(glm::normalize(glm::dvec3(3, -1, 1)), 1.1);
  const Placement plain, turned{.transform = transform_of(turn, move)},
      mirrored{.transform = transform_of(mirror, -0.5 * move)}, sheared{.transform = transform_of(shear, 0.75 * move)};
  const auto with_mask = [](Placement placement, std::uint32_t mask) {
    placement.mask = mask;
    return placement;
  };
  const auto with_flags = [](rhi::InstanceFlags flags) { return std::vector{Placement{.flags = flags}}; };
  switch (arrangement) {
    case Arrangement::turned:
      return {turned};
    case Arrangement::mirrored:
    case Arrangement::build_transform:
      return {mirrored};
    case Arrangement::sheared:
      return {sheared};
    case Arrangement::masked:
      return {with_mask(plain, 0x01), with_mask(turned, 0x80), with_mask(mirrored, 0x10), with_mask(sheared, 0x0c)};
    case Arrangement::flipped:
      return with_flags(rhi::InstanceFlags::triangle_flip_facing);
    case Arrangement::unculled:
      return with_flags(rhi::InstanceFlags::triangle_facing_cull_disable);
    case Arrangement::forced_opaque:
      return with_flags(rhi::InstanceFlags::force_opaque);
    case Arrangement::forced_no_opaque:
      return with_flags(rhi::InstanceFlags::force_no_opaque);
    default:
      return {plain};
  }
}

std::uint32_t custom_index(std::uint32_t placement, bool spheres) {
  return 0xa5c300u + 16 * placement + (spheres ? 9 : 5);
}

std::uint32_t hit_record(std::uint32_t placement, bool spheres) { return 2 * (placement % 2) + (spheres ? 1 : 0); }

}  // namespace tandem::compare
