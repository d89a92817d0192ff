#include "rhi_cpu/trace/embree/vertex_hit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "rhi_cpu/trace/embree/candidates.hpp"
#include "rhi_cpu/trace/embree/triangle_on_ray.hpp"

namespace tandem::cpu {
namespace {

/// Far enough to the side for the rounding errors of Embree's test, which are some units in the last place of the
/// distance, not to matter: 256 of them. With 32, two of 10^5 rays at the vertices of long spikes slipped through
/// again.
constexpr float side_step = 0x1p-16f;

/// A bound of those errors: of the moment of the ray about an edge, for each unit of the length of the edge and of the
/// direction, and of the distance of the edge.
constexpr double moment_error = 8 * 0x1p-24;

/// The ray, turned to one side or the other along the axis in which it goes least, or in which it goes second least.
kernel::Ray beside(kernel::Ray ray, int side) {
  std::array<std::size_t, 3> axes = {0, 1, 2};
  std::sort(axes.begin(), axes.end(),
            [&](std::size_t a, std::size_t b) { return std::abs(ray.direction[a]) < std::abs(ray.direction[b]); });
  const float step = side_step * std::abs(ray.direction[axes[2]]);
  ray.direction[axes[side < 2 ? 0 : 1]] += side % 2 == 0 ? step : -step;
  return ray;
}

/// Corrects t and barycentrics of `hit` to those of the ray. False if the ray clearly passes by the triangle, or is not
/// at one of its vertices: along edges Embree is right, and a ray that just misses an outer edge has met nothing.
bool meets_triangle(const TopLevelScene& scene, const kernel::Ray& ray, kernel::Hit& hit) {
  const TriangleOnRay triangle = triangle_on_ray(scene, ray, hit);
  const auto& [corners, direction, moments] = triangle;
  bool may_be_positive = true, may_be_negative = true;
  int edges_within_rounding = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector& a = corners[(i + 1) % 3];
    const Vector& b = corners[(i + 2) % 3];
    const double error = moment_error * length(b - a) * (length(a) + length(b)) * length(direction);
    may_be_positive = may_be_positive && moments[i] >= -error;
    may_be_negative = may_be_negative && moments[i] <= error;
    edges_within_rounding += std::abs(moments[i]) <= error ? 1 : 0;
  }
  if ((!may_be_positive && !may_be_negative) || edges_within_rounding < 2) return false;
  const Vector normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double t = dot(corners[0], normal) / dot(direction, normal);
  if (!(t > double{ray.t_min} && t < double{ray.t_max})) return false;
  hit.t = static_cast<float>(t);
  if (!(hit.t > ray.t_min && hit.t < ray.t_max)) return false;
  set_barycentrics(triangle, hit);
  return true;
}

}  // namespace

bool find_vertex_hit(const TopLevelScene& scene, const kernel::Ray& ray, kernel::Hit& hit) {
  if ((ray.flags & kernel::ray_flag_terminate_on_first_hit) != 0) return false;
  for (int side = 0; side < 4; ++side) {
    // Where the ray meets nothing to the side either, it is not at a vertex.
    if (gather_triangles(scene, beside(ray, side), {&hit, 1}) == 0) return false;
    if (meets_triangle(scene, ray, hit)) return true;
  }
  return false;
}

}  // namespace tandem::cpu
