#pragma once

#include <cstdint>

/// How a translated shader traces rays: through plain data and a table of functions, so that a kernel neither links nor
/// knows what is behind it (Embree, or the exact tracer).
namespace tandem::kernel {

/// Vulkan ray flags (SPIR-V RayFlags), the values that rayQueryInitializeEXT takes.
enum RayFlag : std::uint32_t {
  ray_flag_opaque = 0x01,
  ray_flag_no_opaque = 0x02,
  ray_flag_terminate_on_first_hit = 0x04,
  ray_flag_skip_closest_hit_shader = 0x08,
  ray_flag_cull_back_facing_triangles = 0x10,
  ray_flag_cull_front_facing_triangles = 0x20,
  ray_flag_cull_opaque = 0x40,
  ray_flag_cull_no_opaque = 0x80,
  ray_flag_skip_triangles = 0x100,
  ray_flag_skip_aabbs = 0x200
};

/// A ray in world space, as rayQueryInitializeEXT receives it. A triangle is hit at t_min < t < t_max, both ends
/// excluded (Vulkan specification, "Ray Intersection Candidate Determination").
struct alignas(16) Ray {
  float origin[3];
  float t_min;
  float direction[3];  ///< not normalised: t counts in its lengths
  float t_max;
  std::uint32_t flags;
  std::uint32_t mask;  ///< 8 bits
};

/// Four floats. A ray travels as two of them, because Embree loads it so: a vector load that follows
/// scalar stores waits for them, which costs a tenth of a simple ray.
using FloatVector = float __attribute__((vector_size(16)));

struct RayVectors {
  FloatVector origin;     ///< and t_min
  FloatVector direction;  ///< and t_max
  std::uint32_t flags;
  std::uint32_t mask;
};
static_assert(sizeof(RayVectors) == sizeof(Ray));

/// A triangle that a ray meets.
struct Hit {
  float t;
  float barycentrics[2];         ///< weights of the second and third vertex
  std::uint32_t instance_index;  ///< position in the top level's instance buffer: gl_InstanceID
  std::uint32_t geometry_index;
  std::uint32_t primitive_index;
  bool front_face;
  bool opaque;  ///< commits without the shader's confirmation; `closest` and `occluded` treat every hit so
};

/// What the getters of a hit need of its instance.
struct Instance {
  float object_to_world[3][4];  ///< row-major
  float world_to_object[3][4];
  std::uint32_t custom_index;
  std::uint32_t sbt_offset;
};

struct TopLevel;

/// All of them leave out what the ray's mask and flags cull, expect a ray with t_min < t_max, and are thread-safe.
struct TraceFunctions {
  /// The closest hit, opaque or not; it counts as opaque.
  bool (*closest)(const TopLevel& scene, const Ray& ray, Hit& hit);
  /// Whether there is any hit, opaque or not.
  bool (*occluded)(const TopLevel& scene, const Ray& ray);
  /// The first hit after `previous`, or the first of all when it is null, in the total order (t, instance, geometry,
  /// primitive), opaque or not. Repeated, it enumerates every hit of the ray exactly once, also those of equal t.
  bool (*next_hit)(const TopLevel& scene, const Ray& ray, const Hit* previous, Hit& hit);
};

/// A built top level as a kernel sees it; the backend derives its own from it. An acceleration structure's Resource
/// points at one.
struct TopLevel {
  const TraceFunctions* functions;
  const Instance* instances;
  std::uint32_t instance_count;
  bool all_opaque;  ///< no hit is a candidate unless the ray has ray_flag_no_opaque
};

}  // namespace tandem::kernel
