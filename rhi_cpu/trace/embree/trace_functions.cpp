#include "rhi_cpu/trace/embree/candidates.hpp"
#include "rhi_cpu/trace/embree/filter.hpp"
#include "rhi_cpu/trace/embree/packets.hpp"
#include "rhi_cpu/trace/embree/triangle_on_ray.hpp"
#include "rhi_cpu/trace/embree/vertex_hit.hpp"

namespace tandem::cpu {
namespace {

using kernel::Hit;
using kernel::Ray;

const TopLevelScene& scene_of(const kernel::TopLevel& top_level) {
  return static_cast<const TopLevelScene&>(top_level);
}

void reject_culled(const RTCFilterFunctionNArguments* arguments) {
  const auto& context = *static_cast<const FilterContext*>(arguments->context);
  const Hit hit = filtered_hit(context, *arguments);
  if (is_culled(context.scene->traits[hit.instance_index], *context.ray, hit)) arguments->valid[0] = 0;
}

bool closest(const kernel::TopLevel& top_level, const Ray& ray, Hit& hit) {
  const TopLevelScene& scene = scene_of(top_level);
  if (!is_traceable(scene, scene.triangles, ray)) return false;
  RTCRayHit query;
  set_ray(ray, first_included(ray.t_min), last_included(ray.t_max), query.ray);
  clear_hit(query.hit);
  if (needs_filter(scene, ray.flags)) {
    if ((ray.flags & kernel::ray_flag_skip_triangles) != 0) return false;
    FilterContext context;
    initialize_context(context, scene, scene.triangles, ray);
    intersect(scene.triangles.scene, query, context, &reject_culled);
  } else {
    intersect(scene.triangles.scene, query);
  }
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) [[unlikely]] {
    if (!find_vertex_hit(scene, ray, hit)) return false;
    hit.opaque = true;
    return true;
  }

  hit.t = query.ray.tfar;
  hit.barycentrics[0] = query.hit.u;
  hit.barycentrics[1] = query.hit.v;
  hit.instance_index = instance_of(scene.triangles, query.hit.instID[0]);
  hit.geometry_index = query.hit.geomID;
  hit.primitive_index = query.hit.primID;
  if (has_no_barycentrics(hit)) [[unlikely]]
    restore_barycentrics(scene, ray, hit);
  float direction[3] = {ray.direction[0], ray.direction[1], ray.direction[2]};
  if (!scene.triangles.direct) {
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
  if (!is_traceable(scene, scene.triangles, ray)) return false;
  RTCRay query;
  set_ray(ray, first_included(ray.t_min), last_included(ray.t_max), query);
  if (needs_filter(scene, ray.flags)) {
    if ((ray.flags & kernel::ray_flag_skip_triangles) != 0) return false;
    FilterContext context;
    initialize_context(context, scene, scene.triangles, ray);
    occlude(scene.triangles.scene, query, context, &reject_culled);
  } else {
    occlude(scene.triangles.scene, query);
  }
  return query.tfar < 0;
}

bool visit(const kernel::TopLevel& top_level, const Ray& ray, const kernel::CandidateVisitor& visitor, Hit& committed) {
  if (!visitor.visits_opaque_triangles && !kernel::can_meet_candidates(top_level, ray.flags))
    return closest(top_level, ray, committed);
  return visit_candidates(scene_of(top_level), ray, visitor, committed);
}

std::uint32_t next_hits(const kernel::TopLevel& top_level, const Ray& ray, const Hit* previous, Hit* hits,
                        std::uint32_t capacity) {
  return gather_candidates(scene_of(top_level), ray, previous, {hits, capacity});
}

}  // namespace

const kernel::TraceFunctions embree_trace_functions = {.closest = &closest,
                                                       .occluded = &occluded,
                                                       .next_hits = &next_hits,
                                                       .visit = &visit,
                                                       .closest_of_packet = &closest_of_packet,
                                                       .occluded_of_packet = &occluded_of_packet};

}  // namespace tandem::cpu
