#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <variant>

#include "rhi_cpu/trace/exact/box.hpp"
#include "rhi_cpu/trace/exact/scene.hpp"
#include "rhi_cpu/trace/exact/triangle.hpp"
#include "rhi_cpu/trace/packets.hpp"

namespace tandem::cpu::exact {
namespace {

using kernel::Hit;
using kernel::Ray;

const TopLevelScene& scene_of(const kernel::TopLevel& top_level) {
  return static_cast<const TopLevelScene&>(top_level);
}

bool is_finite(std::span<const float, 3> v) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

/// The total order of hits. Rounding keeps the order of exact t, so what is exactly nearer comes first, unless its t is
/// the same float.
auto order_of(const Hit& hit) { return std::tie(hit.t, hit.instance_index, hit.geometry_index, hit.primitive_index); }

/// The exact t beyond which none rounds to `t`.
double last_that_rounds_to(float t) { return double{std::nextafter(t, std::numeric_limits<float>::infinity())}; }
double first_that_rounds_to(float t) { return double{std::nextafter(t, -std::numeric_limits<float>::infinity())}; }

/// Vulkan specification, "Ray Opacity Culling": the geometry's flag, overridden by the instance's, overridden by the
/// ray's.
bool is_opaque(const InstanceTraits& instance, rhi::GeometryFlags geometry_flags, std::uint32_t ray_flags) {
  bool opaque = rhi::has(geometry_flags, rhi::GeometryFlags::opaque);
  if (rhi::has(instance.flags, rhi::InstanceFlags::force_opaque))
    opaque = true;
  else if (rhi::has(instance.flags, rhi::InstanceFlags::force_no_opaque))
    opaque = false;
  if ((ray_flags & kernel::ray_flag_opaque) != 0)
    opaque = true;
  else if ((ray_flags & kernel::ray_flag_no_opaque) != 0)
    opaque = false;
  return opaque;
}

/// The same section: what the ray's flags cull by opacity.
bool is_culled_by_opacity(bool opaque, std::uint32_t ray_flags) {
  return (ray_flags & (opaque ? kernel::ray_flag_cull_opaque : kernel::ray_flag_cull_no_opaque)) != 0;
}

/// Vulkan specification, "Ray Face Culling".
bool is_culled_by_face(const InstanceTraits& instance, bool front_face, std::uint32_t ray_flags) {
  if (rhi::has(instance.flags, rhi::InstanceFlags::triangle_facing_cull_disable)) return false;
  return (ray_flags & (front_face ? kernel::ray_flag_cull_front_facing_triangles
                                  : kernel::ray_flag_cull_back_facing_triangles)) != 0;
}

/// Vulkan specification, "Ray Intersection Candidate Determination": a triangle is a candidate at t_min < t < t_max. It
/// is the t that a shader reads, a float, that is compared, so that a shader never reads one outside of its interval.
bool meet(const Ray& ray, const InstanceTraits& instance, const TriangleMesh& mesh, Hit& hit) {
  if ((ray.flags & kernel::ray_flag_skip_triangles) != 0) return false;
  hit.opaque = is_opaque(instance, mesh.flags, ray.flags);
  if (is_culled_by_opacity(hit.opaque, ray.flags)) return false;
  const TriangleIndices& corners = mesh.triangles[hit.primitive_index];
  const std::optional<TriangleHit> met = intersect(
      ray, instance.transform, {mesh.positions[corners[0]], mesh.positions[corners[1]], mesh.positions[corners[2]]});
  if (!met || !(met->t > ray.t_min && met->t < ray.t_max)) return false;
  hit.t = met->t;
  hit.barycentrics[0] = met->barycentrics[0];
  hit.barycentrics[1] = met->barycentrics[1];
  hit.front_face = met->front_face != rhi::has(instance.flags, rhi::InstanceFlags::triangle_flip_facing);
  hit.is_box = false;
  return !is_culled_by_face(instance, hit.front_face, ray.flags);
}

/// The same section: a box is a candidate when the ray is inside of it or on its surface anywhere in [t_min, t_max].
bool meet(const Ray& ray, const InstanceTraits& instance, const BoxSet& set, Hit& hit) {
  if ((ray.flags & kernel::ray_flag_skip_aabbs) != 0) return false;
  hit.opaque = is_opaque(instance, set.flags, ray.flags);
  if (is_culled_by_opacity(hit.opaque, ray.flags)) return false;
  const std::optional<float> t = entry_of(ray, instance.transform, set.boxes[hit.primitive_index]);
  if (!t) return false;
  hit.t = *t;
  hit.barycentrics[0] = hit.barycentrics[1] = 0;
  hit.front_face = false;
  hit.is_box = true;
  return true;
}

/// Calls on_hit(hit) for everything that the ray meets and that neither its mask nor its flags cull, in no particular
/// order, until it returns false. It may shorten the interval to what still matters.
/// @param interval of exact t, within t_min and t_max
template <class OnHit>
void for_each_hit(const TopLevelScene& scene, const Ray& ray, const Interval& interval, const OnHit& on_hit) {
  if (!is_finite(ray.origin) || !is_finite(ray.direction)) return;
  const Vector<BoundedNumber> origin{std::span(ray.origin)};
  const Vector<BoundedNumber> direction{std::span(ray.direction)};
  scene.bvh.traverse(RayLine(origin, direction), interval, [&](std::uint32_t active) {
    const std::uint32_t instance_index = scene.active_instances[active];
    const InstanceTraits& instance = scene.traits[instance_index];
    // Vulkan specification, "Ray Mask Culling".
    if ((instance.mask & ray.mask) == 0) return true;
    const BottomLevelScene& bottom_level = *instance.bottom_level;
    const RayLine line = to_object(instance.transform, origin, direction);
    return bottom_level.bvh.traverse(line, interval, [&](std::uint32_t item) {
      const PrimitiveId id = bottom_level.primitives[item];
      Hit hit;
      hit.instance_index = instance_index;
      hit.geometry_index = id.geometry;
      hit.primitive_index = id.primitive;
      const bool met = std::visit([&](const auto& geometry) { return meet(ray, instance, geometry, hit); },
                                  bottom_level.geometries[id.geometry]);
      return !met || on_hit(hit);
    });
  });
}

Interval interval_of(const Ray& ray) { return {.first = double{ray.t_min}, .last = double{ray.t_max}}; }

Ray triangles_only(const Ray& ray) {
  Ray result = ray;
  result.flags |= kernel::ray_flag_skip_aabbs;
  return result;
}

bool closest(const kernel::TopLevel& top_level, const Ray& ray, Hit& hit) {
  Interval interval = interval_of(ray);
  bool found = false;
  for_each_hit(scene_of(top_level), triangles_only(ray), interval, [&](const Hit& each) {
    if (found && order_of(each) >= order_of(hit)) return true;
    hit = each;
    hit.opaque = true;
    found = true;
    interval.last = last_that_rounds_to(hit.t);
    return true;
  });
  return found;
}

bool occluded(const kernel::TopLevel& top_level, const Ray& ray) {
  bool found = false;
  for_each_hit(scene_of(top_level), triangles_only(ray), interval_of(ray), [&](const Hit&) {
    found = true;
    return false;
  });
  return found;
}

std::uint32_t next_hits(const kernel::TopLevel& top_level, const Ray& ray, const Hit* previous, Hit* hits,
                        std::uint32_t capacity) {
  if (capacity == 0) return 0;
  Interval interval = interval_of(ray);
  if (previous != nullptr) interval.first = std::max(interval.first, first_that_rounds_to(previous->t));
  std::uint32_t count = 0;
  for_each_hit(scene_of(top_level), ray, interval, [&](const Hit& hit) {
    if (previous != nullptr && order_of(hit) <= order_of(*previous)) return true;
    const auto before = [](const Hit& a, const Hit& b) { return order_of(a) < order_of(b); };
    Hit* const end = hits + count;
    Hit* const place = std::upper_bound(hits, end, hit, before);
    if (place == hits + capacity) return true;
    std::move_backward(place, count < capacity ? end : end - 1, count < capacity ? end + 1 : end);
    *place = hit;
    count = std::min(count + 1, capacity);
    if (count == capacity) interval.last = std::min(interval.last, last_that_rounds_to(hits[capacity - 1].t));
    return true;
  });
  return count;
}

bool visit(const kernel::TopLevel& top_level, const Ray& ray, const kernel::CandidateVisitor& visitor, Hit& committed) {
  using kernel::CandidateDecision;
  Interval interval = interval_of(ray);
  bool found = false;
  for_each_hit(scene_of(top_level), ray, interval, [&](const Hit& hit) {
    Hit candidate = hit;
    CandidateDecision decision = CandidateDecision::commit;
    if (hit.is_box) {
      if (found && hit.t > committed.t) return true;
      decision = visitor.box(visitor.context, candidate, found ? committed.t : ray.t_max);
    } else {
      if (found && order_of(hit) >= order_of(committed)) return true;
      if (!hit.opaque || visitor.visits_opaque_triangles) decision = visitor.triangle(visitor.context, hit);
    }
    if (decision == CandidateDecision::ignore) return true;
    committed = candidate;
    found = true;
    interval.last = last_that_rounds_to(committed.t);
    const bool is_first_enough = (ray.flags & kernel::ray_flag_terminate_on_first_hit) != 0;
    return !is_first_enough && decision != CandidateDecision::commit_and_terminate;
  });
  return found;
}

}  // namespace

const kernel::TraceFunctions exact_trace_functions = {.closest = &closest,
                                                      .occluded = &occluded,
                                                      .next_hits = &next_hits,
                                                      .visit = &visit,
                                                      .closest_of_packet = &closest_by_ray,
                                                      .occluded_of_packet = &occluded_by_ray};

}  // namespace tandem::cpu::exact
