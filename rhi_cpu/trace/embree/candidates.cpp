#include "rhi_cpu/trace/embree/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "rhi_cpu/trace/embree/filter.hpp"
#include "rhi_cpu/trace/embree/ray_box.hpp"
#include "rhi_cpu/trace/embree/vertex_hit.hpp"

namespace tandem::cpu {
namespace {

using kernel::Hit;
using kernel::Ray;

/// What Embree's callbacks find in their arguments when every hit is looked at.
///
/// Embree passes by nodes of its tree that lie behind tfar or before tnear. A triangle whose t is rounded to a value
/// outside of its node would be lost that way, so the search reaches a little farther at both ends than the hits that
/// it is for, and what they are offered to decides exactly.
struct CandidateContext : FilterContext {
  /// Takes a hit or not, and then sets `reach` to how far the ray has to look from now on.
  bool (*offer)(CandidateContext& context, Hit& hit);
  bool any_offered;       ///< a triangle or a box
  float slack_at_origin;  ///< see rounding_slack
  float reach;
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

float rounding_slack(const CandidateContext& context, float t) { return context.slack_at_origin + relative_slack * t; }

auto order_of(const Hit& hit) { return std::tie(hit.t, hit.instance_index, hit.geometry_index, hit.primitive_index); }

bool is_opaque_triangle(const Hit& hit) { return hit.opaque && !hit.is_box; }

bool offer(CandidateContext& context, Hit& hit) {
  context.any_offered = true;
  return context.offer(context, hit);
}

void offer_triangle(const RTCFilterFunctionNArguments* arguments) {
  auto& context = *static_cast<CandidateContext*>(arguments->context);
  const Ray& ray = *context.ray;
  Hit hit = filtered_hit(context, *arguments);
  if (!(hit.t > ray.t_min && hit.t < ray.t_max) || is_culled(context.scene->traits[hit.instance_index], ray, hit) ||
      !offer(context, hit)) {
    arguments->valid[0] = 0;
    return;
  }
  RTCRayN_tfar(arguments->ray, 1, 0) = context.reach;
}

/// Offers the triangles from `t_first` on that may be in reach, then the boxes.
void offer_all(CandidateContext& context, float t_first) {
  const TopLevelScene& scene = *context.scene;
  const Ray& ray = *context.ray;
  RTCRayHit query;
  if ((ray.flags & kernel::ray_flag_skip_triangles) == 0 && is_traceable(scene, scene.triangles, ray)) {
    context.traced = &scene.triangles;
    set_ray(ray, std::max(t_first, first_included(ray.t_min)), last_included(ray.t_max), query.ray);
    clear_hit(query.hit);
    intersect(scene.triangles.scene, query, context, &offer_triangle);
  }
  if (scene.has_boxes && (ray.flags & kernel::ray_flag_skip_aabbs) == 0 && context.reach >= 0 &&
      is_traceable(scene, scene.boxes, ray)) {
    context.traced = &scene.boxes;
    const float t_begin = std::max(ray.t_min - rounding_slack(context, ray.t_min), t_first);
    set_ray(ray, std::max(t_begin, 0.0f), context.reach, query.ray);
    clear_hit(query.hit);
    intersect(scene.boxes.scene, query, context);
  }
}

/// next_hits: keeps the first hits in order.
struct GatheringContext : CandidateContext {
  const Hit* previous;
  std::span<Hit> hits;
  std::uint32_t count;
};

bool keep_among_first(CandidateContext& base, Hit& hit) {
  auto& context = static_cast<GatheringContext&>(base);
  const std::span<Hit> hits = context.hits;
  std::uint32_t& count = context.count;
  if (context.previous != nullptr && order_of(hit) <= order_of(*context.previous)) return false;
  const auto is_complete = [&] { return count == hits.size() || (count > 0 && is_opaque_triangle(hits[count - 1])); };
  if (is_complete() && order_of(hit) >= order_of(hits[count - 1])) return false;
  std::uint32_t position = std::min<std::uint32_t>(count, static_cast<std::uint32_t>(hits.size()) - 1);
  count = position + 1;
  for (; position > 0 && order_of(hit) < order_of(hits[position - 1]); --position) hits[position] = hits[position - 1];
  hits[position] = hit;
  if (is_opaque_triangle(hit)) count = position + 1;
  if (!is_complete()) return false;
  const float t = hits[count - 1].t;
  context.reach = std::min(context.reach, t + rounding_slack(context, t));
  return true;
}

/// visit: keeps the closest of what is committed.
struct VisitingContext : CandidateContext {
  const kernel::CandidateVisitor* visitor;
  Hit* committed;
  bool found;
  bool finished;
};

bool decide(CandidateContext& base, Hit& hit) {
  auto& context = static_cast<VisitingContext&>(base);
  if (context.finished) return false;
  if (context.found && order_of(hit) >= order_of(*context.committed)) return false;
  auto decision = kernel::CandidateDecision::commit;
  if (hit.is_box)
    decision =
        context.visitor->box(context.visitor->context, hit, context.found ? context.committed->t : context.ray->t_max);
  else if (!hit.opaque || context.visitor->visits_opaque_triangles)
    decision = context.visitor->triangle(context.visitor->context, hit);
  if (decision == kernel::CandidateDecision::ignore) return false;
  *context.committed = hit;
  context.found = true;
  context.finished = decision == kernel::CandidateDecision::commit_and_terminate ||
                     (context.ray->flags & kernel::ray_flag_terminate_on_first_hit) != 0;
  context.reach = context.finished ? -std::numeric_limits<float>::infinity()
                                   : std::min(context.reach, hit.t + rounding_slack(context, hit.t));
  return true;
}

void initialize_context(CandidateContext& context, const TopLevelScene& scene, const Ray& ray,
                        bool (*offer)(CandidateContext&, Hit&)) {
  initialize_context(context, scene, scene.triangles, ray);
  context.offer = offer;
  context.any_offered = false;
  context.slack_at_origin = slack_at_origin(ray);
  context.reach = ray.t_max + rounding_slack(context, ray.t_max);
}

GatheringContext gather(const TopLevelScene& scene, const Ray& ray, const Hit* previous, std::span<Hit> hits) {
  GatheringContext context;
  initialize_context(context, scene, ray, &keep_among_first);
  context.previous = previous;
  context.hits = hits;
  context.count = 0;
  offer_all(context, previous != nullptr ? previous->t - rounding_slack(context, previous->t) : 0.0f);
  return context;
}

}  // namespace

void meet_box(const RTCIntersectFunctionNArguments* arguments) {
  auto& context = *static_cast<CandidateContext*>(arguments->context);
  const Ray& ray = *context.ray;
  const auto& set = *static_cast<const BoxSet*>(arguments->geometryUserPtr);
  const std::uint32_t instance_index = instance_of(*context.traced, arguments->context->instID[0]);
  const InstanceTraits& instance = context.scene->traits[instance_index];
  Hit hit = {.t = 0,
             .barycentrics = {0, 0},
             .instance_index = instance_index,
             .geometry_index = arguments->geomID,
             .primitive_index = arguments->primID,
             .front_face = false,
             .opaque = is_opaque(instance, arguments->geomID, ray.flags),
             .is_box = true};
  if (arguments->valid[0] == 0 || is_culled(instance, ray, hit) ||
      !meets_box(ray, context.scene->instances[instance_index], set.boxes[arguments->primID], hit.t) ||
      !offer(context, hit))
    return;
  reinterpret_cast<RTCRayHit*>(arguments->rayhit)->ray.tfar = context.reach;
}

std::uint32_t gather_triangles(const TopLevelScene& scene, const Ray& ray, std::span<Hit> hits) {
  Ray triangles_only = ray;
  triangles_only.flags |= kernel::ray_flag_skip_aabbs;
  return gather(scene, triangles_only, nullptr, hits).count;
}

std::uint32_t gather_candidates(const TopLevelScene& scene, const Ray& ray, const Hit* previous, std::span<Hit> hits) {
  if (hits.empty()) return 0;
  const GatheringContext context = gather(scene, ray, previous, hits);
  if (previous != nullptr || context.any_offered) return context.count;
  return find_vertex_hit(scene, ray, hits[0]) ? 1 : 0;
}

bool visit_candidates(const TopLevelScene& scene, const Ray& ray, const kernel::CandidateVisitor& visitor,
                      Hit& committed) {
  VisitingContext context;
  initialize_context(context, scene, ray, &decide);
  context.visitor = &visitor;
  context.committed = &committed;
  context.found = context.finished = false;
  offer_all(context, 0.0f);
  Hit hit;
  if (!context.any_offered && find_vertex_hit(scene, ray, hit)) decide(context, hit);
  return context.found;
}

}  // namespace tandem::cpu
