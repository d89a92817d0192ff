#include "tests/rhi_cpu/trace/embree/brute_force.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace tandem::test {
namespace {

using glm::dmat3;
using glm::dvec3;

struct ExactTransform {
  dmat3 to_object;
  dvec3 origin;
  bool invertible;
};

ExactTransform inverse_of(const rhi::InstanceDesc& instance) {
  dmat3 linear;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) linear[column][row] = double{instance.object_to_world[row][column]};
  }
  const dvec3 origin(instance.object_to_world[0][3], instance.object_to_world[1][3], instance.object_to_world[2][3]);
  const double determinant = glm::determinant(linear);
  if (!std::isfinite(determinant) || determinant == 0) return {dmat3(0), origin, false};
  return {glm::inverse(linear), origin, true};
}

bool has_flag(const rhi::InstanceDesc& instance, rhi::InstanceFlags flag) {
  return rhi::has(static_cast<rhi::InstanceFlags>(instance.flags), flag);
}

bool opaque_of(const rhi::InstanceDesc& instance, const SoupGeometry& geometry, std::uint32_t ray_flags) {
  bool opaque = geometry.opaque;
  if (has_flag(instance, rhi::InstanceFlags::force_opaque)) opaque = true;
  if (has_flag(instance, rhi::InstanceFlags::force_no_opaque)) opaque = false;
  if (ray_flags & kernel::ray_flag_opaque) opaque = true;
  if (ray_flags & kernel::ray_flag_no_opaque) opaque = false;
  return opaque;
}

bool culled(const rhi::InstanceDesc& instance, std::uint32_t ray_flags, const ExactHit& hit) {
  if (hit.is_box && (ray_flags & kernel::ray_flag_skip_aabbs)) return true;
  if (!hit.is_box && (ray_flags & kernel::ray_flag_skip_triangles)) return true;
  if (hit.opaque && (ray_flags & kernel::ray_flag_cull_opaque)) return true;
  if (!hit.opaque && (ray_flags & kernel::ray_flag_cull_no_opaque)) return true;
  if (hit.is_box) return false;
  if (has_flag(instance, rhi::InstanceFlags::triangle_facing_cull_disable)) return false;
  if (hit.front_face && (ray_flags & kernel::ray_flag_cull_front_facing_triangles)) return true;
  return !hit.front_face && (ray_flags & kernel::ray_flag_cull_back_facing_triangles);
}

// What single precision may decide either way. The margins are far above its errors (the tolerances below are about
// 1e-5) and far below the size of a triangle.
constexpr double edge_margin = 1e-3;
constexpr double end_margin = 1e-3;
constexpr double least_cosine = 0.02;

/// Moeller and Trumbore (1997). Appends the hit if there is one; returns false when that is ambiguous.
bool intersect(const dvec3& origin, const dvec3& direction, const kernel::Ray& ray, const Triangle& triangle,
               double coordinate_size, ExactHit& hit, bool& found) {
  found = false;
  const dvec3 a(triangle[0], triangle[1], triangle[2]);
  const dvec3 ab = dvec3(triangle[3], triangle[4], triangle[5]) - a;
  const dvec3 ac = dvec3(triangle[6], triangle[7], triangle[8]) - a;
  const dvec3 p = glm::cross(direction, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant == 0) return true;
  const dvec3 s = origin - a;
  const dvec3 q = glm::cross(s, ab);
  hit.u = glm::dot(s, p) / determinant;
  hit.v = glm::dot(direction, q) / determinant;
  hit.t = glm::dot(ac, q) / determinant;
  const double inside = std::min({hit.u, hit.v, 1 - hit.u - hit.v});
  if (inside < -edge_margin) return true;

  const double t_min = double{ray.t_min}, t_max = double{ray.t_max};
  const double end_distance = std::min(hit.t - t_min, t_max - hit.t);
  const double t_scale = std::abs(hit.t) + coordinate_size / glm::length(direction);
  if (end_distance < -end_margin * t_scale) return true;

  const dvec3 normal = glm::cross(ab, ac);
  const double cosine = std::abs(glm::dot(normal, direction)) / (glm::length(normal) * glm::length(direction));
  if (inside < edge_margin || end_distance < end_margin * t_scale || cosine < least_cosine) return false;

  hit.front_face = glm::dot(normal, direction) < 0;
  // An error of the origin or of a vertex of 256 units in the last place of the largest coordinate, which covers the
  // single-precision inverse of a transform of condition 30, seen along the ray and across the triangle.
  const double position_tolerance = 256 * 0x1p-24 * (coordinate_size + hit.t * glm::length(direction));
  const double smallest_height =
      glm::length(normal) / std::max({glm::length(ab), glm::length(ac), glm::length(ac - ab)});
  hit.t_tolerance = position_tolerance / (glm::length(direction) * cosine);
  hit.uv_tolerance = position_tolerance / (smallest_height * cosine);
  found = true;
  return true;
}

/// The same of a box.
bool intersect(const dvec3& origin, const dvec3& direction, const kernel::Ray& ray, const BoxCorners& box,
               double coordinate_size, ExactHit& hit, bool& found) {
  hit.t = double{ray.t_min};
  hit.t_exit = double{ray.t_max};
  hit.t_tolerance = 0;
  hit.is_box = true;
  const double position_tolerance = 256 * 0x1p-24 * coordinate_size;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double a = (double{box[i]} - origin[axis]) / direction[axis];
    const double b = (double{box[i + 3]} - origin[axis]) / direction[axis];
    if (std::min(a, b) > hit.t) {
      hit.t = std::min(a, b);
      hit.t_tolerance = position_tolerance / std::abs(direction[axis]) + 256 * 0x1p-24 * hit.t;
    }
    hit.t_exit = std::min(hit.t_exit, std::max(a, b));
  }
  const double length = hit.t_exit - hit.t;
  const double margin = end_margin * (hit.t + coordinate_size / glm::length(direction));
  found = length > margin;
  return std::abs(length) > margin;
}

double size_of(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

float uniform(std::mt19937& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

glm::vec3 uniform_vector(std::mt19937& random, float size) {
  const float x = uniform(random, -size, size);
  const float y = uniform(random, -size, size);
  return {x, y, uniform(random, -size, size)};
}

/// Rotation about z, then about x, after scaling the axes by factors that may be negative.
void set_transform(rhi::InstanceDesc& instance, const glm::vec3& scale, float angle_z, float angle_x,
                   const glm::vec3& translation) {
  const float cz = std::cos(angle_z), sz = std::sin(angle_z), cx = std::cos(angle_x), sx = std::sin(angle_x);
  const float rotation[3][3] = {{cz, -sz, 0}, {cx * sz, cx * cz, -sx}, {sx * sz, sx * cz, cx}};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      instance.object_to_world[row][column] = rotation[row][column] * scale[column];
    instance.object_to_world[row][3] = translation[row];
  }
}

}  // namespace

rhi::InstanceDesc instance_of(std::size_t index) {
  rhi::InstanceDesc instance{};
  for (int i = 0; i < 3; ++i) instance.object_to_world[i][i] = 1;
  instance.mask = 0xFF;
  instance.blas_address = index + 1;
  return instance;
}

std::vector<cpu::GeometryInput> inputs_of(const std::vector<SoupGeometry>& geometries) {
  std::vector<cpu::GeometryInput> inputs;
  for (const SoupGeometry& geometry : geometries) {
    const auto flags = geometry.opaque ? rhi::GeometryFlags::opaque : rhi::GeometryFlags::none;
    if (!geometry.boxes.empty()) {
      inputs.push_back(cpu::BoxInput{.boxes = std::as_bytes(std::span(geometry.boxes)),
                                     .box_count = static_cast<std::uint32_t>(geometry.boxes.size()),
                                     .flags = flags});
      continue;
    }
    const auto count = static_cast<std::uint32_t>(geometry.triangles.size());
    inputs.push_back(cpu::TriangleInput{.vertices = std::as_bytes(std::span(geometry.triangles)),
                                        .vertex_count = 3 * count,
                                        .triangle_count = count,
                                        .flags = flags});
  }
  return inputs;
}

BuiltSoup build(const cpu::EmbreeDevice& device, const Soup& soup, rhi::BuildFlags flags) {
  std::vector<cpu::BottomLevel> bottom_levels;
  for (const std::vector<SoupGeometry>& geometries : soup.bottom_levels)
    bottom_levels.push_back(cpu::BottomLevel::build(device, inputs_of(geometries), flags, "soup"));
  cpu::TopLevel top_level = cpu::TopLevel::build(
      device, soup.instances, [&](std::uint64_t address) { return &bottom_levels.at(address - 1); }, flags, "soup");
  return {std::move(bottom_levels), std::move(top_level)};
}

ExactHits all_hits(const Soup& soup, const kernel::Ray& ray) {
  ExactHits result;
  const dvec3 world_origin(ray.origin[0], ray.origin[1], ray.origin[2]);
  const dvec3 world_direction(ray.direction[0], ray.direction[1], ray.direction[2]);
  for (std::uint32_t i = 0; i < soup.instances.size(); ++i) {
    const rhi::InstanceDesc& instance = soup.instances[i];
    if ((instance.mask & ray.mask) == 0 || instance.blas_address == 0) continue;
    const ExactTransform transform = inverse_of(instance);
    if (!transform.invertible) continue;
    const dvec3 origin = transform.to_object * (world_origin - transform.origin);
    const dvec3 direction = transform.to_object * world_direction;
    const std::vector<SoupGeometry>& geometries = soup.bottom_levels[instance.blas_address - 1];
    // Vertices lie within 1 of the origin of object space.
    const double coordinate_size =
        1 + size_of(transform.to_object * world_origin) + size_of(transform.to_object * transform.origin);
    for (std::uint32_t g = 0; g < geometries.size(); ++g) {
      const auto meet_all = [&](const auto& primitives) {
        for (std::uint32_t p = 0; p < primitives.size(); ++p) {
          ExactHit hit{};
          bool found;
          if (!intersect(origin, direction, ray, primitives[p], coordinate_size, hit, found)) result.ambiguous = true;
          if (!found) continue;
          hit.instance_index = i;
          hit.geometry_index = g;
          hit.primitive_index = p;
          hit.opaque = opaque_of(instance, geometries[g], ray.flags);
          hit.front_face =
              !hit.is_box && hit.front_face != has_flag(instance, rhi::InstanceFlags::triangle_flip_facing);
          if (!culled(instance, ray.flags, hit)) result.hits.push_back(hit);
        }
      };
      meet_all(geometries[g].triangles);
      meet_all(geometries[g].boxes);
    }
  }
  std::sort(result.hits.begin(), result.hits.end(), [](const ExactHit& a, const ExactHit& b) { return a.t < b.t; });
  return result;
}

Soup random_soup(std::mt19937& random, std::size_t geometry_count, std::size_t triangle_count) {
  Soup soup;
  for (int level = 0; level < 2; ++level) {
    std::vector<SoupGeometry>& geometries = soup.bottom_levels.emplace_back();
    for (std::size_t g = 0; g < geometry_count; ++g) {
      SoupGeometry& geometry = geometries.emplace_back();
      geometry.opaque = g % 2 == 0;
      for (std::size_t i = 0; i < triangle_count; ++i) {
        const glm::vec3 center = uniform_vector(random, 0.7f);
        Triangle& triangle = geometry.triangles.emplace_back();
        for (int corner = 0; corner < 3; ++corner) {
          const glm::vec3 position = center + uniform_vector(random, 0.3f);
          for (int axis = 0; axis < 3; ++axis) triangle[static_cast<std::size_t>(corner * 3 + axis)] = position[axis];
        }
      }
    }
  }
  std::vector<SoupGeometry>& of_boxes = soup.bottom_levels.emplace_back();
  for (std::size_t g = 0; g < geometry_count; ++g) {
    SoupGeometry& geometry = of_boxes.emplace_back();
    geometry.opaque = g % 2 == 0;
    for (std::size_t i = 0; i < triangle_count / 12 + 1; ++i) {
      const glm::vec3 center = uniform_vector(random, 0.6f);
      BoxCorners& box = geometry.boxes.emplace_back();
      for (int axis = 0; axis < 3; ++axis) {
        const auto position = static_cast<std::size_t>(axis);
        box[position] = center[axis] - uniform(random, 0.02f, 0.3f);
        box[position + 3] = center[axis] + uniform(random, 0.02f, 0.3f);
      }
    }
  }
  const std::uint32_t instance_flags[] = {0, 1, 2, 3, 4, 8, 2 | 4, 1 | 2 | 8, 0, 1, 4, 8};
  const std::uint32_t masks[] = {0xFF, 0x01, 0x80, 0xF0, 0x0F, 0xFF, 0x11, 0x00, 0xFF, 0x80, 0x0F, 0x18};
  for (std::size_t i = 0; i < std::size(instance_flags); ++i) {
    rhi::InstanceDesc& instance = soup.instances.emplace_back(instance_of(i < 8 ? i % 2 : 2));
    const glm::vec3 translation = uniform_vector(random, 1.5f);
    glm::vec3 scale;
    for (int axis = 0; axis < 3; ++axis) {
      scale[axis] = uniform(random, 0.4f, 1.5f) * (uniform(random, 0, 1) < 0.5f ? -1.0f : 1.0f);
    }
    const float angle = 2 * std::numbers::pi_v<float>;
    const float angle_z = uniform(random, 0, angle);
    set_transform(instance, scale, angle_z, uniform(random, 0, angle), translation);
    instance.mask = masks[i] & 0xFF;
    instance.flags = instance_flags[i] & 0xFF;
    instance.custom_index = static_cast<std::uint32_t>(1000 + i) & 0xFFFFFF;
    instance.sbt_offset = static_cast<std::uint32_t>(2000 + i) & 0xFFFFFF;
  }
  rhi::InstanceDesc nowhere = instance_of(0);
  nowhere.blas_address = 0;
  rhi::InstanceDesc flat = instance_of(1);
  flat.object_to_world[1][1] = 0;
  soup.instances.insert(soup.instances.begin() + 2, {nowhere, flat});
  return soup;
}

kernel::Ray random_ray(std::mt19937& random, std::uint32_t flags, std::uint32_t mask) {
  const glm::vec3 origin = uniform_vector(random, 2.5f);
  const glm::vec3 target = uniform_vector(random, 1.0f);
  const float length = std::pow(10.0f, uniform(random, -1, 1));
  const glm::vec3 direction = glm::normalize(target - origin) * length;
  const float t_min = uniform(random, 0, 1) < 0.5f ? 0.0f : 0.3f / length;
  const float t_max = uniform(random, 0, 1) < 0.5f ? 4.0f / length : INFINITY;
  return {.origin = {origin.x, origin.y, origin.z},
          .t_min = t_min,
          .direction = {direction.x, direction.y, direction.z},
          .t_max = t_max,
          .flags = flags,
          .mask = mask};
}

}  // namespace tandem::test
