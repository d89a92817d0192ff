#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

#include "rhi_cpu/trace/scene.hpp"

namespace tandem::cpu {
namespace {

using kernel::Hit;
using kernel::Ray;

const TopLevelScene& scene_of(const kernel::TopLevel& top_level) {
  return static_cast<const TopLevelScene&>(top_level);
}

/// Embree's interval of t is closed, ours is open: these are the floats next to its ends. A t_min of 0 excludes
/// denormal t too, because Embree multiplies by its bounds, and denormal factors are slow.
float first_included(float t_min) {
  if (t_min <= 0) return std::numeric_limits<float>::min();
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(t_min) + 1);
}

float last_included(float t_max) {
  if (t_max <= 0) return 0;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(t_max) - 1);
}

void set_ray(const Ray& ray, float t_first, float t_last, RTCRay& embree_ray) {
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

void clear_hit(RTCHit& hit) {
  hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

using IntegerVector = std::int32_t __attribute__((vector_size(16)));

/// Whether Embree may be given the ray, and has anything to find: Debian's Embree ends the program for a coordinate
/// that is NaN or beyond its range.
bool is_traceable(const TopLevelScene& scene, const Ray& ray) {
  // A scene that is traced without its instance level has no instance whose mask Embree could test.
  if (scene.direct && (scene.traits[scene.direct_instance].mask & ray.mask) == 0) return false;
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

std::uint32_t instance_of(const TopLevelScene& scene, unsigned embree_instance) {
  return scene.direct ? scene.direct_instance : embree_instance;
}

/// Vulkan specification, "Ray Face Culling": seen along the ray in a left-handed coordinate system, the vertices of a
/// front face run clockwise, which is to say that (v1 - v0) x (v2 - v0), Embree's normal, points against the ray.
/// "Because the facing is determined in object space, an instance transform does not change the winding, but a geometry
/// transform does" (VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR): a mirroring instance keeps the facing of its
/// triangles.
/// @param normal,direction both in object space
bool is_front_face(const InstanceTraits& instance, const float (&normal)[3], const float (&direction)[3]) {
  const float cosine = normal[0] * direction[0] + normal[1] * direction[1] + normal[2] * direction[2];
  return (cosine < 0) != rhi::has(instance.flags, rhi::InstanceFlags::triangle_flip_facing);
}

/// Vulkan specification, "Ray Opacity Culling": the geometry's flag, overridden by the instance's, overridden by the
/// ray's.
bool is_opaque(const InstanceTraits& instance, std::uint32_t geometry, std::uint32_t ray_flags) {
  if ((ray_flags & kernel::ray_flag_opaque) != 0) return true;
  if ((ray_flags & kernel::ray_flag_no_opaque) != 0) return false;
  if (rhi::has(instance.flags, rhi::InstanceFlags::force_opaque)) return true;
  if (rhi::has(instance.flags, rhi::InstanceFlags::force_no_opaque)) return false;
  return rhi::has(instance.bottom_level->flags[geometry], rhi::GeometryFlags::opaque);
}

bool is_culled(const InstanceTraits& instance, const Ray& ray, const Hit& hit) {
  const std::uint32_t flags = ray.flags;
  if ((flags & (hit.opaque ? kernel::ray_flag_cull_opaque : kernel::ray_flag_cull_no_opaque)) != 0) return true;
  if ((instance.mask & ray.mask) == 0) return true;
  if (rhi::has(instance.flags, rhi::InstanceFlags::triangle_facing_cull_disable)) return false;
  return (flags & (hit.front_face ? kernel::ray_flag_cull_front_facing_triangles
                                  : kernel::ray_flag_cull_back_facing_triangles)) != 0;
}

/// Whether the ray can meet a hit that its flags cull, so that a filter has to look at each.
bool needs_filter(const TopLevelScene& scene, const Ray& ray) {
  constexpr std::uint32_t culling = kernel::ray_flag_cull_back_facing_triangles |
                                    kernel::ray_flag_cull_front_facing_triangles | kernel::ray_flag_cull_opaque |
                                    kernel::ray_flag_cull_no_opaque;
  return (ray.flags & culling) != 0 || (scene.masks_in_filter && !scene.direct);
}

/// What a filter finds in its arguments.
struct FilterContext : EmbreeContext {
  const TopLevelScene* scene;
  const Ray* ray;
};

/// What next_hits' filter finds in its arguments.
struct OrderedContext : FilterContext {
  const Hit* previous;
  float slack_at_origin;  ///< see rounding_slack
  float t_last;
  bool found;
  Hit best;
};

/// Relative distance by which rounding may put the t of a hit away from where the ray enters the box around its
/// triangle: 64 units in the last place.
constexpr float relative_slack = 0x1p-18f;

float largest_component(const float (&v)[3]) { return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}); }

/// The same for the coordinates of the origin, in units of t.
float slack_at_origin(const Ray& ray) {
  const float slack = relative_slack * largest_component(ray.origin) / largest_component(ray.direction);
  return std::isfinite(slack) ? slack : 0.0f;
}

float rounding_slack(const OrderedContext& context, float t) { return context.slack_at_origin + relative_slack * t; }

/// The hit that a filter is asked about; we trace single rays only. In a filter, Embree's ray and normal are in object
/// space.
Hit filtered_hit(const FilterContext& context, const RTCFilterFunctionNArguments& arguments) {
  const TopLevelScene& scene = *context.scene;
  const std::uint32_t instance_index = instance_of(scene, RTCHitN_instID(arguments.hit, 1, 0, 0));
  const std::uint32_t geometry_index = RTCHitN_geomID(arguments.hit, 1, 0);
  const InstanceTraits& instance = scene.traits[instance_index];
  const float normal[3] = {RTCHitN_Ng_x(arguments.hit, 1, 0), RTCHitN_Ng_y(arguments.hit, 1, 0),
                           RTCHitN_Ng_z(arguments.hit, 1, 0)};
  const float direction[3] = {RTCRayN_dir_x(arguments.ray, 1, 0), RTCRayN_dir_y(arguments.ray, 1, 0),
                              RTCRayN_dir_z(arguments.ray, 1, 0)};
  return {.t = RTCRayN_tfar(arguments.ray, 1, 0),
          .barycentrics = {RTCHitN_u(arguments.hit, 1, 0), RTCHitN_v(arguments.hit, 1, 0)},
          .instance_index = instance_index,
          .geometry_index = geometry_index,
          .primitive_index = RTCHitN_primID(arguments.hit, 1, 0),
          .front_face = is_front_face(instance, normal, direction),
          .opaque = is_opaque(instance, geometry_index, context.ray->flags),
          .is_box = false};
}

void reject_culled(const RTCFilterFunctionNArguments* arguments) {
  const auto& context = *static_cast<const FilterContext*>(arguments->context);
  const Hit hit = filtered_hit(context, *arguments);
  if (is_culled(context.scene->traits[hit.instance_index], *context.ray, hit)) arguments->valid[0] = 0;
}

auto order_of(const Hit& hit) { return std::tie(hit.t, hit.instance_index, hit.geometry_index, hit.primitive_index); }

void keep_first_after_previous(const RTCFilterFunctionNArguments* arguments) {
  auto& context = *static_cast<OrderedContext*>(arguments->context);
  const Ray& ray = *context.ray;
  const Hit hit = filtered_hit(context, *arguments);
  if (!(hit.t > ray.t_min && hit.t < ray.t_max) ||
      (context.previous != nullptr && order_of(hit) <= order_of(*context.previous)) ||
      (context.found && order_of(hit) >= order_of(context.best)) ||
      is_culled(context.scene->traits[hit.instance_index], ray, hit)) {
    arguments->valid[0] = 0;
    return;
  }
  context.best = hit;
  context.found = true;
  RTCRayN_tfar(arguments->ray, 1, 0) = std::min(hit.t + rounding_slack(context, hit.t), context.t_last);
}

bool closest(const kernel::TopLevel& top_level, const Ray& ray, Hit& hit) {
  const TopLevelScene& scene = scene_of(top_level);
  if (!is_traceable(scene, ray)) return false;
  RTCRayHit query;
  set_ray(ray, first_included(ray.t_min), last_included(ray.t_max), query.ray);
  clear_hit(query.hit);
  if (needs_filter(scene, ray)) {
    FilterContext context;
    initialize_context(context);
    context.scene = &scene;
    context.ray = &ray;
    intersect(scene.scene, query, context, &reject_culled);
  } else {
    intersect(scene.scene, query);
  }
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;

  hit.t = query.ray.tfar;
  hit.barycentrics[0] = query.hit.u;
  hit.barycentrics[1] = query.hit.v;
  hit.instance_index = instance_of(scene, query.hit.instID[0]);
  hit.geometry_index = query.hit.geomID;
  hit.primitive_index = query.hit.primID;
  float direction[3] = {ray.direction[0], ray.direction[1], ray.direction[2]};
  if (!scene.direct) {
    const auto& m = scene.instances[hit.instance_index].world_to_object;
    for (int row = 0; row < 3; ++row) {
      direction[row] = m[row][0] * ray.direction[0] + m[row][1] * ray.direction[1] + m[row][2] * ray.direction[2];
    }
  }
  hit.front_face =
      is_front_face(scene.traits[hit.instance_index], {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z}, direction);
  hit.opaque = true;
  hit.is_box = false;
  return true;
}

bool occluded(const kernel::TopLevel& top_level, const Ray& ray) {
  const TopLevelScene& scene = scene_of(top_level);
  if (!is_traceable(scene, ray)) return false;
  RTCRay query;
  set_ray(ray, first_included(ray.t_min), last_included(ray.t_max), query);
  if (needs_filter(scene, ray)) {
    FilterContext context;
    initialize_context(context);
    context.scene = &scene;
    context.ray = &ray;
    occlude(scene.scene, query, context, &reject_culled);
  } else {
    occlude(scene.scene, query);
  }
  return query.tfar < 0;
}

std::uint32_t next_hits(const kernel::TopLevel& top_level, const Ray& ray, const Hit* previous, Hit* hits,
                        std::uint32_t capacity) {
  const TopLevelScene& scene = scene_of(top_level);
  if (capacity == 0 || !is_traceable(scene, ray)) return 0;
  // Embree passes by boxes that lie behind the nearest hit so far or before tnear. A triangle whose t is rounded to a
  // value outside of its box would be lost that way, so the search reaches a little farther at both ends, and the
  // filter decides exactly.
  OrderedContext context;
  initialize_context(context);
  context.scene = &scene;
  context.ray = &ray;
  context.previous = previous;
  context.slack_at_origin = slack_at_origin(ray);
  context.t_last = last_included(ray.t_max);
  context.found = false;
  float t_first = first_included(ray.t_min);
  if (previous != nullptr) t_first = std::max(t_first, previous->t - rounding_slack(context, previous->t));
  RTCRayHit query;
  set_ray(ray, t_first, context.t_last, query.ray);
  clear_hit(query.hit);
  intersect(scene.scene, query, context, &keep_first_after_previous);
  if (context.found) hits[0] = context.best;
  return context.found ? 1 : 0;
}

}  // namespace

const kernel::TraceFunctions embree_trace_functions = {
    .closest = &closest, .occluded = &occluded, .next_hits = &next_hits, .visit = nullptr};

}  // namespace tandem::cpu
