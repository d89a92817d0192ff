#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "rhi_cpu/trace/embree/scene.hpp"
#include "rhi_cpu/trace/embree/triangle_on_ray.hpp"

/// How rays go into Embree, and what becomes of the hits that come out: what all trace functions have in common.
namespace tandem::cpu {

/// Embree's interval of t is closed, ours is open: these are the floats next to its ends. A t_min of 0 excludes
/// denormal t too, because Embree multiplies by its bounds, and denormal factors are slow.
inline float first_included(float t_min) {
  if (t_min <= 0) return std::numeric_limits<float>::min();
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(t_min) + 1);
}

inline float last_included(float t_max) {
  if (t_max <= 0) return 0;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(t_max) - 1);
}

inline void set_ray(const kernel::Ray& ray, float t_first, float t_last, RTCRay& embree_ray) {
  auto vectors = std::bit_cast<kernel::RayVectors>(ray);
  vectors.origin[3] = t_first;
  vectors.direction[3] = 0;  // time
  static_assert(offsetof(RTCRay, tnear) == offsetof(RTCRay, org_x) + 12 &&
                offsetof(RTCRay, time) == offsetof(RTCRay, dir_x) + 12);
  *reinterpret_cast<kernel::FloatVector*>(&embree_ray.org_x) = vectors.origin;
  *reinterpret_cast<kernel::FloatVector*>(&embree_ray.dir_x) = vectors.direction;
  embree_ray.tfar = t_last;
  embree_ray.mask = ray.mask;
  embree_ray.id = 0;
  embree_ray.flags = 0;
}

inline void clear_hit(RTCHit& hit) {
  hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

using IntegerVector = std::int32_t __attribute__((vector_size(16)));

/// Whether Embree may be given the ray, and has anything to find: Debian's Embree ends the program for a coordinate
/// that is NaN or beyond its range.
inline bool is_traceable(const TopLevelScene& scene, const TracedScene& traced, const kernel::Ray& ray) {
  // A scene that is traced without its instance level has no instance whose mask Embree could test.
  if (traced.direct && (scene.traits[traced.direct_instance].mask & ray.mask) == 0) return false;
  // Magnitudes of floats order like their bits, and NaN comes above all of them; the fourth elements are t_min and
  // t_max.
  const auto vectors = std::bit_cast<kernel::RayVectors>(ray);
  const std::int32_t limit = std::bit_cast<std::int32_t>(scene.coordinate_limit);
  constexpr std::int32_t magnitude = 0x7FFFFFFF;
  const IntegerVector too_large =
      ((std::bit_cast<IntegerVector>(vectors.origin) & IntegerVector{magnitude, magnitude, magnitude, 0}) > limit) |
      ((std::bit_cast<IntegerVector>(vectors.direction) & IntegerVector{magnitude, magnitude, magnitude, 0}) > limit);
  const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(too_large);
  return (halves[0] | halves[1]) == 0;
}

inline std::uint32_t instance_of(const TracedScene& traced, unsigned embree_instance) {
  return traced.direct ? traced.direct_instance : embree_instance;
}

/// Vulkan specification, "Ray Face Culling": seen along the ray in a left-handed coordinate system, the vertices of a
/// front face run clockwise, which is to say that (v1 - v0) x (v2 - v0), Embree's normal, points against the ray.
/// "Because the facing is determined in object space, an instance transform does not change the winding, but a geometry
/// transform does" (VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR): a mirroring instance keeps the facing of its
/// triangles.
/// @param normal,direction both in object space
inline bool is_front_face(const InstanceTraits& instance, const float (&normal)[3], const float (&direction)[3]) {
  const float cosine = normal[0] * direction[0] + normal[1] * direction[1] + normal[2] * direction[2];
  return (cosine < 0) != rhi::has(instance.flags, rhi::InstanceFlags::triangle_flip_facing);
}

/// Vulkan specification, "Ray Opacity Culling": the geometry's flag, overridden by the instance's, overridden by the
/// ray's.
inline bool is_opaque(const InstanceTraits& instance, std::uint32_t geometry, std::uint32_t ray_flags) {
  if ((ray_flags & kernel::ray_flag_opaque) != 0) return true;
  if ((ray_flags & kernel::ray_flag_no_opaque) != 0) return false;
  if (rhi::has(instance.flags, rhi::InstanceFlags::force_opaque)) return true;
  if (rhi::has(instance.flags, rhi::InstanceFlags::force_no_opaque)) return false;
  return rhi::has(instance.bottom_level->flags[geometry], rhi::GeometryFlags::opaque);
}

/// Whether the ray's flags and mask leave the hit out. Vulkan specification, "Ray Face Culling": of triangles only.
inline bool is_culled(const InstanceTraits& instance, const kernel::Ray& ray, const kernel::Hit& hit) {
  const std::uint32_t flags = ray.flags;
  if ((flags & (hit.opaque ? kernel::ray_flag_cull_opaque : kernel::ray_flag_cull_no_opaque)) != 0) return true;
  if ((instance.mask & ray.mask) == 0) return true;
  if (hit.is_box || rhi::has(instance.flags, rhi::InstanceFlags::triangle_facing_cull_disable)) return false;
  return (flags & (hit.front_face ? kernel::ray_flag_cull_front_facing_triangles
                                  : kernel::ray_flag_cull_back_facing_triangles)) != 0;
}

/// Whether a ray can meet a hit that its flags cull, so that a filter has to look at each.
inline bool needs_filter(const TopLevelScene& scene, std::uint32_t flags) {
  constexpr std::uint32_t culling = kernel::ray_flag_cull_back_facing_triangles |
                                    kernel::ray_flag_cull_front_facing_triangles | kernel::ray_flag_cull_opaque |
                                    kernel::ray_flag_cull_no_opaque | kernel::ray_flag_skip_triangles;
  return (flags & culling) != 0 || (scene.masks_in_filter && !scene.triangles.direct);
}

/// What a filter finds in its arguments.
struct FilterContext : EmbreeContext {
  const TopLevelScene* scene;
  const TracedScene* traced;
  const kernel::Ray* ray;
};

inline void initialize_context(FilterContext& context, const TopLevelScene& scene, const TracedScene& traced,
                               const kernel::Ray& ray) {
  initialize_context(context);
  context.scene = &scene;
  context.traced = &traced;
  context.ray = &ray;
}

/// The hit that a filter is asked about; we trace single rays only. In a filter, Embree's ray and normal are in object
/// space.
inline kernel::Hit filtered_hit(const FilterContext& context, const RTCFilterFunctionNArguments& arguments) {
  const std::uint32_t instance_index = instance_of(*context.traced, RTCHitN_instID(arguments.hit, 1, 0, 0));
  const std::uint32_t geometry_index = RTCHitN_geomID(arguments.hit, 1, 0);
  const InstanceTraits& instance = context.scene->traits[instance_index];
  const float normal[3] = {RTCHitN_Ng_x(arguments.hit, 1, 0), RTCHitN_Ng_y(arguments.hit, 1, 0),
                           RTCHitN_Ng_z(arguments.hit, 1, 0)};
  const float direction[3] = {RTCRayN_dir_x(arguments.ray, 1, 0), RTCRayN_dir_y(arguments.ray, 1, 0),
                              RTCRayN_dir_z(arguments.ray, 1, 0)};
  kernel::Hit hit = {.t = RTCRayN_tfar(arguments.ray, 1, 0),
                     .barycentrics = {RTCHitN_u(arguments.hit, 1, 0), RTCHitN_v(arguments.hit, 1, 0)},
                     .instance_index = instance_index,
                     .geometry_index = geometry_index,
                     .primitive_index = RTCHitN_primID(arguments.hit, 1, 0),
                     .front_face = is_front_face(instance, normal, direction),
                     .opaque = is_opaque(instance, geometry_index, context.ray->flags),
                     .is_box = false};
  if (has_no_barycentrics(hit)) [[unlikely]]
    restore_barycentrics(*context.scene, *context.ray, hit);
  return hit;
}

}  // namespace tandem::cpu
