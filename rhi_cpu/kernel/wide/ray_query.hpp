#pragma once

#include "rhi_cpu/kernel/ray_query.hpp"
#include "rhi_cpu/kernel/wide/memory.hpp"

/// GLSL_EXT_ray_query for all lanes at once. Rays that can meet no candidates, which are most, are traced as packets;
/// every other lane has a rayQueryEXT of its own, of which what the getters read is kept in lanes too.
namespace tandem::kernel {

/// A kernel::Hit per lane.
struct WideHit {
  Lanes<float> t;
  glm::vec<2, Lanes<float>> barycentrics;
  Lanes<std::uint32_t> instance_index;
  Lanes<std::uint32_t> geometry_index;
  Lanes<std::uint32_t> primitive_index;
  Mask front_face;
  Mask is_box;
};

struct WideRayQuery {
  const TopLevel* scene[lane_count] = {};
  glm::vec<3, Lanes<float>> origin = glm::vec<3, Lanes<float>>(0.0f);
  glm::vec<3, Lanes<float>> direction = glm::vec<3, Lanes<float>>(0.0f);
  Lanes<float> t_min = 0.0f;
  Lanes<float> t_max = 0.0f;
  Lanes<std::uint32_t> flags = 0u;
  Lanes<std::uint32_t> cull_mask = 0u;
  WideHit committed;
  WideHit candidate;
  Mask waits = false;  ///< initialised, not traced yet
  Mask has_committed = false;
  Mask is_unknown = false;  ///< what is committed is known to exist, not yet what it is
  Mask is_single = false;   ///< `single` has the state
  rayQueryEXT single[lane_count];
};

template <>
struct WideOf<rayQueryEXT> {
  using type = WideRayQuery;
};

inline void clear(WideHit& hit, Mask mask, const Lanes<float>& t) {
  assign(mask, hit.t, t);
  assign(mask, hit.barycentrics, glm::vec<2, Lanes<float>>(0.0f));
  assign(mask, hit.instance_index, Lanes<std::uint32_t>(no_instance));
  assign(mask, hit.geometry_index, Lanes<std::uint32_t>(0u));
  assign(mask, hit.primitive_index, Lanes<std::uint32_t>(0u));
  hit.front_face = hit.front_face && !mask;
  hit.is_box = hit.is_box && !mask;
}

inline void set_hit(WideHit& wide, int lane, const Hit& hit) {
  wide.t.set(lane, hit.t);
  wide.barycentrics.x.set(lane, hit.barycentrics[0]);
  wide.barycentrics.y.set(lane, hit.barycentrics[1]);
  wide.instance_index.set(lane, hit.instance_index);
  wide.geometry_index.set(lane, hit.geometry_index);
  wide.primitive_index.set(lane, hit.primitive_index);
  wide.front_face.set(lane, hit.front_face);
  wide.is_box.set(lane, hit.is_box);
}

inline void rayQueryInitializeEXT(Mask mask, WideRayQuery& query, accelerationStructureEXT structure,
                                  const Lanes<std::uint32_t>& flags, const Lanes<std::uint32_t>& cull_mask,
                                  const glm::vec<3, Lanes<float>>& origin, const Lanes<float>& t_min,
                                  const glm::vec<3, Lanes<float>>& direction, const Lanes<float>& t_max) {
  const TopLevel* scene = structure.top_level;
  for (const int lane : EachLane(mask)) query.scene[lane] = scene;
  assign(mask, query.origin, origin);
  assign(mask, query.direction, direction);
  assign(mask, query.t_min, t_min);
  assign(mask, query.t_max, t_max);
  assign(mask, query.flags, flags);
  assign(mask, query.cull_mask, cull_mask & Lanes<std::uint32_t>(0xffu));
  clear(query.committed, mask, t_max);
  clear(query.candidate, mask, Lanes<float>(0.0f));
  query.has_committed = query.has_committed && !mask;
  query.is_unknown = query.is_unknown && !mask;
  query.is_single = query.is_single && !mask;
  // Written so that a NaN at either end meets nothing too.
  Mask meets = t_min < t_max && (cull_mask & Lanes<std::uint32_t>(0xffu)) != Lanes<std::uint32_t>(0u);
  if (scene == nullptr) meets = false;
  if (scene != nullptr) {
    const Mask has_triangles = (flags & Lanes<std::uint32_t>(ray_flag_skip_triangles)) == Lanes<std::uint32_t>(0u);
    const Mask has_boxes = (flags & Lanes<std::uint32_t>(ray_flag_skip_aabbs)) == Lanes<std::uint32_t>(0u);
    meets = meets && (has_triangles || (has_boxes && Mask(scene->has_boxes)));
  }
  query.waits = select(mask, meets, query.waits);
}

inline void take_from_single(WideRayQuery& query, int lane) {
  const rayQueryEXT& single = query.single[lane];
  set_hit(query.committed, lane, single.committed);
  set_hit(query.candidate, lane, single.candidate);
  query.has_committed.set(lane, single.has_committed);
  query.is_unknown.set(lane, single.committed_is_unknown);
}

inline void copy_rays(Mask mask, const WideRayQuery& query, int first, int count, RayPacket& rays) {
  static_assert(sizeof(query.t_min) == lane_count * sizeof(float));
  const auto copy = [&](float* to, const Lanes<float>& from) {
    std::memcpy(to, reinterpret_cast<const float*>(&from) + first, static_cast<std::size_t>(count) * sizeof(float));
  };
  for (int i = 0; i < 3; ++i) {
    copy(rays.origin[i], query.origin[i]);
    copy(rays.direction[i], query.direction[i]);
  }
  copy(rays.t_min, query.t_min);
  copy(rays.t_max, query.t_max);
  rays.active = (bits_of(mask) >> first) & ((1u << count) - 1);
  rays.count = static_cast<std::uint32_t>(count);
}

/// The lanes of `bits`, which begin at lane `first`.
inline Mask mask_of_bits(std::uint32_t bits, int first) {
  Lanes<std::uint32_t> one_each;
  for (int i = 0; i < lane_count; ++i) one_each.set(i, 1u << i);
  return (Lanes<std::uint32_t>(bits << first) & one_each) != Lanes<std::uint32_t>(0u);
}

/// Traces the rays of `mask`, all of one scene and with the same flags and mask, which can meet no candidates.
[[gnu::noinline]] inline void trace_packet(Mask mask, WideRayQuery& query, const TopLevel& scene, std::uint32_t flags,
                                           std::uint32_t cull_mask) {
  constexpr int count = lane_count < 16 ? lane_count : 16;
  RayPacket rays;
  rays.flags = flags;
  rays.mask = cull_mask;
  for (int first = 0; first < lane_count; first += count) {
    copy_rays(mask, query, first, count, rays);
    if (rays.active == 0) continue;
    if ((flags & ray_flag_terminate_on_first_hit) != 0) {
      const Mask found = mask_of_bits(scene.functions->occluded_of_packet(scene, rays), first);
      query.has_committed = query.has_committed || found;
      query.is_unknown = query.is_unknown || found;
      continue;
    }
    HitPacket hits;
    const std::uint32_t found = scene.functions->closest_of_packet(scene, rays, hits);
    if (found == 0) continue;
    const Mask hit = mask_of_bits(found, first);
    query.has_committed = query.has_committed || hit;
    const auto take = [&]<typename T>(Lanes<T>& to, const T* from) {
      Lanes<T> all = to;
      std::memcpy(reinterpret_cast<T*>(&all) + first, from, count * sizeof(T));
      assign(hit, to, all);
    };
    take(query.committed.t, hits.t);
    take(query.committed.barycentrics.x, hits.barycentrics[0]);
    take(query.committed.barycentrics.y, hits.barycentrics[1]);
    take(query.committed.instance_index, hits.instance_index);
    take(query.committed.geometry_index, hits.geometry_index);
    take(query.committed.primitive_index, hits.primitive_index);
    query.committed.front_face = select(hit, mask_of_bits(hits.front_face, first), query.committed.front_face);
  }
}

/// One round of the lanes that have a query of their own.
[[gnu::noinline, gnu::cold]] inline Mask proceed_singly(Mask mask, WideRayQuery& query) {
  Mask result = false;
  for (const int lane : EachLane(mask)) {
    rayQueryEXT& single = query.single[lane];
    if (query.waits[lane]) {
      rayQueryInitializeEXT(single, {query.scene[lane]}, query.flags[lane], query.cull_mask[lane],
                            kernel::lane(query.origin, lane), query.t_min[lane], kernel::lane(query.direction, lane),
                            query.t_max[lane]);
      query.is_single.set(lane, true);
    }
    result.set(lane, rayQueryProceedEXT(single));
    take_from_single(query, lane);
  }
  return result;
}

inline Mask rayQueryProceedEXT(Mask mask, WideRayQuery& query) {
  Mask result = false;
  if (const Mask single = mask && query.is_single; any_of(single)) result = proceed_singly(single, query);
  for (std::uint32_t rest = bits_of(mask && query.waits); rest != 0;) {
    // Those that are traced like the first of them.
    const int first = std::countr_zero(rest);
    const TopLevel* scene = query.scene[first];
    const std::uint32_t flags = query.flags[first], cull_mask = query.cull_mask[first];
    Mask same = mask && query.waits && query.flags == Lanes<std::uint32_t>(flags) &&
                query.cull_mask == Lanes<std::uint32_t>(cull_mask);
    for (const int lane : EachLane(same))
      if (query.scene[lane] != scene) same.set(lane, false);
    if (can_meet_candidates(*scene, flags))
      result = result || proceed_singly(same, query);
    else
      trace_packet(same, query, *scene, flags, cull_mask);
    query.waits = query.waits && !same;
    rest = bits_of(mask && query.waits);
  }
  return result;
}

inline void rayQueryTerminateEXT(Mask mask, WideRayQuery& query) {
  query.waits = query.waits && !mask;
  for (const int lane : EachLane(mask && query.is_single)) rayQueryTerminateEXT(query.single[lane]);
}

inline void rayQueryConfirmIntersectionEXT(Mask mask, WideRayQuery& query) {
  for (const int lane : EachLane(mask && query.is_single)) {
    rayQueryConfirmIntersectionEXT(query.single[lane]);
    take_from_single(query, lane);
  }
}

inline void rayQueryGenerateIntersectionEXT(Mask mask, WideRayQuery& query, const Lanes<float>& t) {
  for (const int lane : EachLane(mask && query.is_single)) {
    rayQueryGenerateIntersectionEXT(query.single[lane], t[lane]);
    take_from_single(query, lane);
  }
}

/// Finds the hits behind `committed` that are not known yet.
[[gnu::noinline, gnu::cold]] inline void find_unknown(WideRayQuery& query) {
  for (const int lane : EachLane(query.is_unknown)) {
    const Ray ray = {.origin = {query.origin.x[lane], query.origin.y[lane], query.origin.z[lane]},
                     .t_min = query.t_min[lane],
                     .direction = {query.direction.x[lane], query.direction.y[lane], query.direction.z[lane]},
                     .t_max = query.t_max[lane],
                     .flags = query.flags[lane],
                     .mask = query.cull_mask[lane]};
    Hit hit;
    if (query.scene[lane]->functions->closest(*query.scene[lane], ray, hit)) {
      hit.is_box = false;
      set_hit(query.committed, lane, hit);
    }
  }
  query.is_unknown = false;
}

/// The hits behind a getter.
inline const WideHit& intersections(WideRayQuery& query, bool committed) {
  if (committed && any_of(query.is_unknown)) [[unlikely]]
    find_unknown(query);
  return committed ? query.committed : query.candidate;
}

inline const Instance* intersected_instance(WideRayQuery& query, bool committed, int lane) {
  const std::uint32_t index = intersections(query, committed).instance_index[lane];
  const TopLevel* scene = query.scene[lane];
  return scene != nullptr && index < scene->instance_count ? &scene->instances[index] : nullptr;
}

/// What `read` gives of the instance that each lane has hit; zero where there is none.
template <typename Read>
inline auto of_instances(WideRayQuery& query, bool committed, const Read& read) {
  using T = decltype(read(std::declval<const Instance&>(), 0));
  wide_t<T> result = kernel::spread(T{});
  for (int lane = 0; lane < lane_count; ++lane)
    if (const Instance* instance = intersected_instance(query, committed, lane))
      kernel::set_lane(result, lane, read(*instance, lane));
  return result;
}

inline Lanes<uint> rayQueryGetIntersectionTypeEXT(WideRayQuery& query, bool committed) {
  if (!committed)
    return select(query.candidate.is_box, Lanes<uint>(candidate_intersection_aabb),
                  Lanes<uint>(candidate_intersection_triangle));
  return select(query.has_committed,
                select(query.committed.is_box, Lanes<uint>(committed_intersection_generated),
                       Lanes<uint>(committed_intersection_triangle)),
                Lanes<uint>(committed_intersection_none));
}
inline Mask rayQueryGetIntersectionCandidateAABBOpaqueEXT(WideRayQuery& query) {
  Mask result = false;
  for (const int lane : EachLane(query.is_single && query.candidate.is_box))
    result.set(lane, query.single[lane].candidate.opaque);
  return result;
}
inline Lanes<float> rayQueryGetIntersectionTEXT(WideRayQuery& query, bool committed) {
  return intersections(query, committed).t;
}
inline Lanes<int> rayQueryGetIntersectionInstanceCustomIndexEXT(WideRayQuery& query, bool committed) {
  return of_instances(query, committed,
                      [](const Instance& instance, int) { return static_cast<int>(instance.custom_index); });
}
inline Lanes<int> rayQueryGetIntersectionInstanceIdEXT(WideRayQuery& query, bool committed) {
  const Lanes<uint> index = intersections(query, committed).instance_index;
  return Lanes<int>(select(index == Lanes<uint>(no_instance), Lanes<uint>(0u), index));
}
inline Lanes<uint> rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(WideRayQuery& query,
                                                                                    bool committed) {
  return of_instances(query, committed, [](const Instance& instance, int) { return uint{instance.sbt_offset}; });
}
inline Lanes<int> rayQueryGetIntersectionGeometryIndexEXT(WideRayQuery& query, bool committed) {
  return Lanes<int>(intersections(query, committed).geometry_index);
}
inline Lanes<int> rayQueryGetIntersectionPrimitiveIndexEXT(WideRayQuery& query, bool committed) {
  return Lanes<int>(intersections(query, committed).primitive_index);
}
inline glm::vec<2, Lanes<float>> rayQueryGetIntersectionBarycentricsEXT(WideRayQuery& query, bool committed) {
  return intersections(query, committed).barycentrics;
}
inline Mask rayQueryGetIntersectionFrontFaceEXT(WideRayQuery& query, bool committed) {
  return intersections(query, committed).front_face;
}
inline glm::vec<3, Lanes<float>> rayQueryGetIntersectionObjectRayDirectionEXT(WideRayQuery& query, bool committed) {
  return of_instances(query, committed, [&](const Instance& instance, int lane) {
    const vec3 direction = kernel::lane(query.direction, lane);
    const float v[3] = {direction.x, direction.y, direction.z};
    const auto& m = instance.world_to_object;
    return vec3(transformed_direction(m[0], v), transformed_direction(m[1], v), transformed_direction(m[2], v));
  });
}
inline glm::vec<3, Lanes<float>> rayQueryGetIntersectionObjectRayOriginEXT(WideRayQuery& query, bool committed) {
  return of_instances(query, committed, [&](const Instance& instance, int lane) {
    const vec3 origin = kernel::lane(query.origin, lane);
    const float v[3] = {origin.x, origin.y, origin.z};
    const auto& m = instance.world_to_object;
    return vec3(transformed_point(m[0], v), transformed_point(m[1], v), transformed_point(m[2], v));
  });
}
inline wide_t<mat4x3> rayQueryGetIntersectionObjectToWorldEXT(WideRayQuery& query, bool committed) {
  return of_instances(query, committed,
                      [](const Instance& instance, int) { return columns_of(instance.object_to_world); });
}
inline wide_t<mat4x3> rayQueryGetIntersectionWorldToObjectEXT(WideRayQuery& query, bool committed) {
  return of_instances(query, committed,
                      [](const Instance& instance, int) { return columns_of(instance.world_to_object); });
}
inline Lanes<float> rayQueryGetRayTMinEXT(WideRayQuery& query) { return query.t_min; }
inline Lanes<uint> rayQueryGetRayFlagsEXT(WideRayQuery& query) { return query.flags; }
inline glm::vec<3, Lanes<float>> rayQueryGetWorldRayDirectionEXT(WideRayQuery& query) { return query.direction; }
inline glm::vec<3, Lanes<float>> rayQueryGetWorldRayOriginEXT(WideRayQuery& query) { return query.origin; }

}  // namespace tandem::kernel
