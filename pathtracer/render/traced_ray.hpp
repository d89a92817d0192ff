#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

/// Rays of the path tracer, one by one: TracedRay of shaders/trace/traced_ray.glsl, byte for byte (std430).
namespace tandem::pathtracer {

enum class RayKind : std::uint32_t {
  closest = 0,   ///< which primitive is the first?
  occlusion = 1  ///< is there any?
};

/// In TracedRay::answer of a closest ray: it meets nothing.
inline constexpr std::uint32_t no_primitive = 0xffffffffu;

/// A ray in world space, and what a device said of it.
struct TracedRay {
  glm::vec3 origin{0};
  float t_max = 0;  ///< in lengths of the direction
  glm::vec3 direction{0};
  RayKind kind = RayKind::closest;
  /// Closest: the triangle (in_device_order), or the number of triangles + the sphere, or no_primitive; occlusion: 1 or
  /// 0.
  std::uint32_t answer = no_primitive;
  /// What decides which transparent triangles the ray meets; see shaders/random.glsl.
  std::uint32_t random_pixel = 0;
  std::uint32_t random_sample = 0;
  std::uint32_t random_dimension = 0;
};
static_assert(sizeof(TracedRay) == 48 && offsetof(TracedRay, answer) == 32);

}  // namespace tandem::pathtracer
