#include "rhi_cpu/trace/embree/vertex_hit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "rhi_cpu/trace/embree/candidates.hpp"

namespace tandem::cpu {
namespace {

using Vector = std::array<double, 3>;

Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vector& a) { return std::sqrt(dot(a, a)); }

Vector transformed(const float (&m)[3][4], const float (&v)[3], float w) {
  Vector result;
  for (std::size_t row = 0; row < 3; ++row) {
    result[row] = double{m[row][3]} * double{w};
    for (std::size_t i = 0; i < 3; ++i) result[row] += double{m[row][i]} * double{v[i]};
  }
  return result;
}

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
  const kernel::Instance& instance = scene.instances[hit.instance_index];
  RTCScene level = scene.traits[hit.instance_index].bottom_level->scene.get();
  RTCGeometry geometry = rtcGetGeometry(level, hit.geometry_index);
  const auto* triangles =
      static_cast<const TriangleIndices*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_INDEX, 0));
  const auto* positions = static_cast<const Position*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));

  const Vector origin = transformed(instance.world_to_object, ray.origin, 1);
  const Vector direction = transformed(instance.world_to_object, ray.direction, 0);
  std::array<Vector, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const Position& p = positions[triangles[hit.primitive_index][i]];
    corners[i] = Vector{double{p[0]}, double{p[1]}, double{p[2]}} - origin;
  }
  // The moment about the edge across from each corner: the weights of the corners, but for a factor.
  Vector moments;
  bool may_be_positive = true, may_be_negative = true;
  int edges_within_rounding = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector& a = corners[(i + 1) % 3];
    const Vector& b = corners[(i + 2) % 3];
    moments[i] = dot(cross(a, b), direction);
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
  const double sum = moments[0] + moments[1] + moments[2];
  if (sum != 0) {
    hit.barycentrics[0] = static_cast<float>(std::clamp(moments[1] / sum, 0.0, 1.0));
    hit.barycentrics[1] = static_cast<float>(std::clamp(moments[2] / sum, 0.0, 1.0));
  }
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
