#include "rhi_cpu/trace/embree/triangle_on_ray.hpp"

#include <algorithm>
#include <cstddef>

namespace tandem::cpu {
namespace {

Vector transformed(const float (&m)[3][4], const float (&v)[3], float w) {
  Vector result;
  for (std::size_t row = 0; row < 3; ++row) {
    result[row] = double{m[row][3]} * double{w};
    for (std::size_t i = 0; i < 3; ++i) result[row] += double{m[row][i]} * double{v[i]};
  }
  return result;
}

}  // namespace

TriangleOnRay triangle_on_ray(const TopLevelScene& scene, const kernel::Ray& ray, const kernel::Hit& hit) {
  const kernel::Instance& instance = scene.instances[hit.instance_index];
  RTCScene level = scene.traits[hit.instance_index].bottom_level->scene.get();
  RTCGeometry geometry = rtcGetGeometry(level, hit.geometry_index);
  const auto* triangles =
      static_cast<const TriangleIndices*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_INDEX, 0));
  const auto* positions = static_cast<const Position*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));

  TriangleOnRay triangle;
  const Vector origin = transformed(instance.world_to_object, ray.origin, 1);
  triangle.direction = transformed(instance.world_to_object, ray.direction, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Position& p = positions[triangles[hit.primitive_index][i]];
    triangle.corners[i] = Vector{double{p[0]}, double{p[1]}, double{p[2]}} - origin;
  }
  for (std::size_t i = 0; i < 3; ++i)
    triangle.moments[i] = dot(cross(triangle.corners[(i + 1) % 3], triangle.corners[(i + 2) % 3]), triangle.direction);
  return triangle;
}

void set_barycentrics(const TriangleOnRay& triangle, kernel::Hit& hit) {
  const Vector& moments = triangle.moments;
  const double sum = moments[0] + moments[1] + moments[2];
  if (sum == 0) return;
  hit.barycentrics[0] = static_cast<float>(std::clamp(moments[1] / sum, 0.0, 1.0));
  hit.barycentrics[1] = static_cast<float>(std::clamp(moments[2] / sum, 0.0, 1.0));
}

void restore_barycentrics(const TopLevelScene& scene, const kernel::Ray& ray, kernel::Hit& hit) {
  const TriangleOnRay triangle = triangle_on_ray(scene, ray, hit);
  const Vector& moments = triangle.moments;
  // Embree's are twice as large. Above its limit the ray goes through the first corner.
  if (2 * std::abs(moments[0] + moments[1] + moments[2]) < 1.001e-18) set_barycentrics(triangle, hit);
}

}  // namespace tandem::cpu
