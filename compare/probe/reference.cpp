#include "compare/probe/reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace tandem::compare {
namespace {

using pathtracer::Bounds;

std::vector<Bounds> bounds_of_triangles(const pathtracer::Scene& scene) {
  std::vector<Bounds> boxes;
  for (const pathtracer::GpuTriangle& triangle : scene.triangles) {
    const glm::vec3 &a = scene.positions[triangle.vertices[0]], &b = scene.positions[triangle.vertices[1]],
                    &c = scene.positions[triangle.vertices[2]];
    boxes.push_back({glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)});
  }
  return boxes;
}

std::vector<Bounds> bounds_of_spheres(const pathtracer::Scene& scene) {
  std::vector<Bounds> boxes;
  for (const pathtracer::GpuSphere& sphere : scene.spheres)
    boxes.push_back({sphere.centre - sphere.radius, sphere.centre + sphere.radius});
  return boxes;
}

/// Whether a primitive counts without further questions: the geometry's flag, overridden by the instance's, overridden
/// by the ray's.
bool is_opaque(std::uint32_t geometry, rhi::InstanceFlags instance, std::uint32_t ray) {
  if ((ray & ray_flag::opaque) != 0) return true;
  if ((ray & ray_flag::no_opaque) != 0) return false;
  if (rhi::has(instance, rhi::InstanceFlags::force_opaque)) return true;
  if (rhi::has(instance, rhi::InstanceFlags::force_no_opaque)) return false;
  return geometry == 0;
}

/// Whether the trial lets a primitive count, whatever its facing.
bool is_let(const Trial& trial, const ProbeInstance& instance, const PrimitiveId& id) {
  if ((trial.flags & (instance.spheres ? ray_flag::skip_boxes : ray_flag::skip_triangles)) != 0) return false;
  const bool opaque = is_opaque(id.geometry, instance.flags, trial.flags);
  if ((trial.flags & (opaque ? ray_flag::cull_opaque : ray_flag::cull_no_opaque)) != 0) return false;
  return opaque || is_accepted(id.geometry, id.primitive, trial.acceptance);
}

/// Whether the facing is the one that the trial culls.
bool is_culled(const Trial& trial, const ProbeInstance& instance, bool front_face) {
  if (rhi::has(instance.flags, rhi::InstanceFlags::triangle_facing_cull_disable)) return false;
  return (trial.flags & (front_face ? ray_flag::cull_front_faces : ray_flag::cull_back_faces)) != 0;
}

}  // namespace

AffineMap map_of(const Transform& transform) {
  AffineMap map;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      map.linear[column][row] = transform[static_cast<std::size_t>(4 * row + column)];
    map.translation[row] = transform[static_cast<std::size_t>(4 * row + 3)];
  }
  return map;
}

AffineMap inverse(const AffineMap& map) {
  const glm::dmat3 linear = glm::inverse(map.linear);
  return {.linear = linear, .translation = -(linear * map.translation)};
}

double mapped_magnitude(const AffineMap& map, const glm::dvec3& point) {
  double magnitude = 0;
  for (int row = 0; row < 3; ++row) {
    double sum = std::abs(map.translation[row]);
    for (int column = 0; column < 3; ++column) sum += std::abs(map.linear[column][row] * point[column]);
    magnitude = std::max(magnitude, sum);
  }
  return magnitude;
}

ProbeReference::ProbeReference(const pathtracer::Scene& scene)
    : scene_(scene), triangles_(bounds_of_triangles(scene)), spheres_(bounds_of_spheres(scene)) {}

std::vector<ProbeInstance> ProbeReference::instances(InstanceSetup instance_setup) const {
  std::vector<ProbeInstance> instances;
  const bool at_build = is_transformed_at_build(instance_setup);
  std::uint32_t number = 0;
  for (const Placement& placement : placements(instance_setup, scene_)) {
    const AffineMap map = map_of(placement.transform);
    for (const bool spheres : {false, true}) {
      if (spheres ? scene_.spheres.empty() || at_build : scene_.triangles.empty()) continue;
      instances.push_back({.world_to_geometry = inverse(map),
                           .transform = at_build ? identity_transform : placement.transform,
                           .custom_index = custom_index(number, spheres),
                           .hit_record = hit_record(number, spheres),
                           .mask = placement.mask,
                           .flags = placement.flags,
                           .spheres = spheres,
                           .mirrored_at_build = at_build && glm::determinant(map.linear) < 0});
    }
    ++number;
  }
  return instances;
}

std::vector<ProbeHit> ProbeReference::hits(const Trial& trial, std::span<const ProbeInstance> instances,
                                           const ProbeRay& ray) const {
  std::vector<ProbeHit> hits;
  double bound = std::numeric_limits<double>::infinity();  // nothing behind this is the first
  for (std::uint32_t number = 0; number < instances.size(); ++number) {
    const ProbeInstance& instance = instances[number];
    if ((instance.mask & trial.mask) == 0) continue;
    const GeometryRay in_geometry = {.origin = instance.world_to_geometry.point(glm::dvec3(ray.origin)),
                                     .direction = instance.world_to_geometry.linear * glm::dvec3(ray.direction),
                                     .magnitude = mapped_magnitude(instance.world_to_geometry, glm::dvec3(ray.origin))};
    const auto visit = [&](std::uint32_t index) {
      const PrimitiveId id = {.type = instance.spheres ? AnswerType::sphere : AnswerType::triangle,
                              .instance = number,
                              .geometry = index % 2,
                              .primitive = index / 2};
      if (!is_let(trial, instance, id)) return bound;
      for (Intersection intersection : meet_primitive(in_geometry, instance, index)) {
        if (!(intersection.t_high >= ray.t_min && intersection.t_low <= ray.t_max) || intersection.t_low > bound)
          continue;
        bool counts = intersection.certain && intersection.t_low > ray.t_min && intersection.t_high < ray.t_max;
        if (!instance.spheres) {
          if (intersection.front_face && is_culled(trial, instance, *intersection.front_face)) continue;
          // Where rounding decides the facing, it decides about culling too.
          counts = counts && intersection.front_face;
        }
        hits.push_back({.id = id, .intersection = intersection, .counts = counts});
        if (counts) bound = std::min(bound, intersection.t_high);
      }
      return bound;
    };
    (instance.spheres ? spheres_ : triangles_).traverse(in_geometry, visit);
  }
  std::erase_if(hits, [&](const ProbeHit& hit) { return hit.intersection.t_low > bound; });
  return hits;
}

std::vector<Intersection> ProbeReference::meet_primitive(const GeometryRay& ray, const ProbeInstance& instance,
                                                         std::uint32_t index) const {
  if (instance.spheres) return meet(ray, scene_.spheres[index]);
  std::optional<Intersection> intersection = meet(ray, corners_of(scene_, index));
  if (!intersection) return {};
  const bool flipped = rhi::has(instance.flags, rhi::InstanceFlags::triangle_flip_facing);
  if (intersection->front_face && flipped != instance.mirrored_at_build)
    intersection->front_face = !*intersection->front_face;
  return {*intersection};
}

}  // namespace tandem::compare
