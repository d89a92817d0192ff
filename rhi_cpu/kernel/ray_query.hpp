#pragma once

#include <bit>
#include <cstdint>

#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// GLSL_EXT_ray_query for translated shaders: a query is a small state machine that pulls hits out of
/// kernel::TraceFunctions. Everything is inline, and no function takes the address of a query or of a part of it, so
/// that the compiler can keep the members of a query in registers.
///
/// Candidates come in the order of where the ray meets them: a triangle's t, or where the ray enters a box. A confirmed
/// triangle therefore ends the search; a hit generated in a box does not, as long as other things begin in front of it.
///
/// What GLSL leaves undefined is defined here: a query that was never initialised, or whose acceleration structure is
/// null, meets nothing; Proceed goes on returning false once it has; Confirm without a triangle and Generate without a
/// box as candidate do nothing, nor does Generate with a t outside of t_min and the committed hit's t (or t_max); both
/// work on the last candidate until the next Proceed, also after Terminate; the getters of a hit that does not exist
/// give zero, but t of the committed hit gives t_max; t of a candidate box is where the ray enters it.
namespace tandem::kernel {

/// accelerationStructureEXT: refers to a built top level, or to nothing.
struct accelerationStructureEXT {
  const TopLevel* top_level = nullptr;
};

/// accelerationStructureEXT(address): the address is AccelerationStructure::device_address() of a top level, or 0.
inline accelerationStructureEXT structure_at(std::uint64_t address) {
  return {address != 0 ? reinterpret_cast<const AddressedTopLevel*>(address)->top_level : nullptr};
}

/// The same with the address as two words, the lower first.
inline accelerationStructureEXT structure_at(uvec2 address) {
  return structure_at(std::bit_cast<std::uint64_t>(address));
}

/// What rayQueryGetIntersectionTypeEXT returns of the committed hit.
inline constexpr uint committed_intersection_none = 0;
inline constexpr uint committed_intersection_triangle = 1;
inline constexpr uint committed_intersection_generated = 2;

/// What it returns of a candidate.
inline constexpr uint candidate_intersection_triangle = 0;
inline constexpr uint candidate_intersection_aabb = 1;

/// Hits that are asked for at once. More take more memory in every query, fewer more traversals.
inline constexpr std::uint32_t hits_at_once = 4;

/// Hits that were asked for. Fewer than hits_at_once: there are no more that matter.
struct HitBatch {
  Hit hits[hits_at_once];
  std::uint32_t count;
  std::uint32_t next;  ///< the one behind the candidate
};

/// In Hit::instance_index: there is no hit.
inline constexpr std::uint32_t no_instance = ~std::uint32_t{0};
inline constexpr Hit no_hit = {.t = 0,
                               .barycentrics = {0, 0},
                               .instance_index = no_instance,
                               .geometry_index = 0,
                               .primitive_index = 0,
                               .front_face = false,
                               .opaque = false,
                               .is_box = false};

enum class RayQueryState : std::uint8_t {
  complete,          ///< Proceed has nothing more to find, and there is no candidate
  initialized,       ///< not traced yet
  at_candidate,      ///< Proceed has returned true
  at_last_candidate  ///< it has, and will not do so again
};

struct rayQueryEXT {
  const TopLevel* scene = nullptr;
  Ray ray = {};
  Hit committed = no_hit;
  Hit candidate = no_hit;
  RayQueryState state = RayQueryState::complete;
  bool has_committed = false;
  /// The committed hit is known to exist, but not yet which it is: most rays that stop at the first hit only ask
  /// whether there is one, which is the cheaper question.
  bool committed_is_unknown = false;
  HitBatch batch;  ///< set once there has been a candidate
};

#define TANDEM_RAY_QUERY_INLINE [[gnu::always_inline]] inline

TANDEM_RAY_QUERY_INLINE void rayQueryInitializeEXT(rayQueryEXT& query, accelerationStructureEXT structure, uint flags,
                                                   uint mask, vec3 origin, float t_min, vec3 direction, float t_max) {
  query.scene = structure.top_level;
  query.committed = query.candidate = no_hit;
  query.has_committed = query.committed_is_unknown = false;
  query.ray = {
      {origin.x, origin.y, origin.z}, t_min, {direction.x, direction.y, direction.z}, t_max, flags, mask & 0xFF};
  query.committed.t = t_max;
  // Written so that a NaN at either end meets nothing too.
  const bool meets_anything = structure.top_level != nullptr && (mask & 0xFF) != 0 && t_min < t_max &&
                              ((flags & ray_flag_skip_triangles) == 0 ||
                               ((flags & ray_flag_skip_aabbs) == 0 && structure.top_level->has_boxes));
  query.state = meets_anything ? RayQueryState::initialized : RayQueryState::complete;
}

/// A copy of a ray, written as vectors whatever registers its members are in.
TANDEM_RAY_QUERY_INLINE Ray vector_copy(const Ray& ray) {
  return std::bit_cast<Ray>(RayVectors{
      .origin = FloatVector{ray.origin[0], ray.origin[1], ray.origin[2], ray.t_min},
      .direction = FloatVector{ray.direction[0], ray.direction[1], ray.direction[2], ray.t_max},
      .flags = ray.flags,
      .mask = ray.mask,
  });
}

/// The one call that finds the hit of a ray which meets no candidates.
TANDEM_RAY_QUERY_INLINE void commit_closest(rayQueryEXT& query, const Ray& ray) {
  const TopLevel& scene = *query.scene;
  Hit hit;
  if ((ray.flags & ray_flag_terminate_on_first_hit) != 0) {
    query.has_committed = query.committed_is_unknown = scene.functions->occluded(scene, ray);
  } else if (scene.functions->closest(scene, ray, hit)) {
    query.committed = hit;
    query.committed.is_box = false;  // for the compiler, which then need not look
    query.has_committed = true;
  }
}

/// The next hit in order. False when there are no more, or none that could still be committed.
/// @param is_first nothing is in `batch` yet
[[gnu::noinline, gnu::cold]] inline bool take_hit(const TopLevel& scene, const Ray& ray, bool is_first, HitBatch& batch,
                                                  Hit& hit) {
  if (is_first || batch.next == batch.count) {
    if (!is_first && batch.count < hits_at_once) return false;
    const Hit previous = is_first ? no_hit : batch.hits[hits_at_once - 1];
    batch.count = scene.functions->next_hits(scene, ray, is_first ? nullptr : &previous, batch.hits, hits_at_once);
    batch.next = 0;
    if (batch.count == 0) return false;
  }
  hit = batch.hits[batch.next++];
  return true;
}

TANDEM_RAY_QUERY_INLINE bool rayQueryProceedEXT(rayQueryEXT& query) {
  const RayQueryState state = query.state;
  query.state = RayQueryState::complete;
  if (state == RayQueryState::complete || state == RayQueryState::at_last_candidate) return false;

  const Ray ray = vector_copy(query.ray);
  if (state == RayQueryState::initialized && !can_meet_candidates(*query.scene, ray.flags)) [[likely]] {
    commit_closest(query, ray);
    return false;
  }

  // Copied as a whole and not touched here, the batch stays in memory, where it costs nothing as long as no candidate
  // is met.
  HitBatch batch;
  if (state != RayQueryState::initialized) batch = query.batch;
  Hit hit;
  if (!take_hit(*query.scene, ray, state == RayQueryState::initialized, batch, hit)) return false;
  query.batch = batch;
  if (query.has_committed && !(hit.t < query.committed.t)) return false;
  if (hit.opaque && !hit.is_box) {
    query.committed = hit;
    query.has_committed = true;
    return false;
  }
  query.candidate = hit;
  query.state = RayQueryState::at_candidate;
  return true;
}

TANDEM_RAY_QUERY_INLINE bool has_candidate(const rayQueryEXT& query) {
  return query.state == RayQueryState::at_candidate || query.state == RayQueryState::at_last_candidate;
}

TANDEM_RAY_QUERY_INLINE void rayQueryTerminateEXT(rayQueryEXT& query) {
  query.state = has_candidate(query) ? RayQueryState::at_last_candidate : RayQueryState::complete;
}

TANDEM_RAY_QUERY_INLINE void rayQueryConfirmIntersectionEXT(rayQueryEXT& query) {
  if (!has_candidate(query) || query.candidate.is_box) return;
  query.committed = query.candidate;
  query.has_committed = true;
  query.state = RayQueryState::at_last_candidate;
}

TANDEM_RAY_QUERY_INLINE void rayQueryGenerateIntersectionEXT(rayQueryEXT& query, float t) {
  if (!has_candidate(query) || !query.candidate.is_box || !(t >= query.ray.t_min && t <= query.committed.t)) return;
  query.committed = query.candidate;
  query.committed.t = t;
  query.has_committed = true;
  if ((query.ray.flags & ray_flag_terminate_on_first_hit) != 0) query.state = RayQueryState::at_last_candidate;
}

TANDEM_RAY_QUERY_INLINE bool rayQueryGetIntersectionCandidateAABBOpaqueEXT(rayQueryEXT& query) {
  return query.candidate.is_box && query.candidate.opaque;
}

/// The hit behind a getter, found now if it is not known yet.
TANDEM_RAY_QUERY_INLINE Hit intersection(rayQueryEXT& query, bool committed) {
  if (!committed) return query.candidate;
  if (query.committed_is_unknown) [[unlikely]] {
    const Ray ray = vector_copy(query.ray);
    Hit hit;
    if (query.scene->functions->closest(*query.scene, ray, hit)) query.committed = hit;
    query.committed_is_unknown = false;
  }
  return query.committed;
}

/// The instance of a hit, or null when there is no hit.
TANDEM_RAY_QUERY_INLINE const Instance* intersected_instance(rayQueryEXT& query, bool committed) {
  const std::uint32_t index = intersection(query, committed).instance_index;
  return query.scene != nullptr && index < query.scene->instance_count ? &query.scene->instances[index] : nullptr;
}

TANDEM_RAY_QUERY_INLINE uint rayQueryGetIntersectionTypeEXT(rayQueryEXT& query, bool committed) {
  if (!committed) return query.candidate.is_box ? candidate_intersection_aabb : candidate_intersection_triangle;
  if (!query.has_committed) return committed_intersection_none;
  return query.committed.is_box ? committed_intersection_generated : committed_intersection_triangle;
}

TANDEM_RAY_QUERY_INLINE float rayQueryGetIntersectionTEXT(rayQueryEXT& query, bool committed) {
  return intersection(query, committed).t;
}

TANDEM_RAY_QUERY_INLINE int rayQueryGetIntersectionInstanceCustomIndexEXT(rayQueryEXT& query, bool committed) {
  const Instance* instance = intersected_instance(query, committed);
  return instance != nullptr ? static_cast<int>(instance->custom_index) : 0;
}

TANDEM_RAY_QUERY_INLINE int rayQueryGetIntersectionInstanceIdEXT(rayQueryEXT& query, bool committed) {
  const std::uint32_t index = intersection(query, committed).instance_index;
  return index != no_instance ? static_cast<int>(index) : 0;
}

TANDEM_RAY_QUERY_INLINE uint rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(rayQueryEXT& query,
                                                                                              bool committed) {
  const Instance* instance = intersected_instance(query, committed);
  return instance != nullptr ? instance->sbt_offset : 0;
}

TANDEM_RAY_QUERY_INLINE int rayQueryGetIntersectionGeometryIndexEXT(rayQueryEXT& query, bool committed) {
  return static_cast<int>(intersection(query, committed).geometry_index);
}

TANDEM_RAY_QUERY_INLINE int rayQueryGetIntersectionPrimitiveIndexEXT(rayQueryEXT& query, bool committed) {
  return static_cast<int>(intersection(query, committed).primitive_index);
}

TANDEM_RAY_QUERY_INLINE vec2 rayQueryGetIntersectionBarycentricsEXT(rayQueryEXT& query, bool committed) {
  const Hit hit = intersection(query, committed);
  return vec2(hit.barycentrics[0], hit.barycentrics[1]);
}

TANDEM_RAY_QUERY_INLINE bool rayQueryGetIntersectionFrontFaceEXT(rayQueryEXT& query, bool committed) {
  return intersection(query, committed).front_face;
}

/// The sum ((x + y) + z) of one row, in the order that Mesa's software rasteriser transforms a ray.
TANDEM_RAY_QUERY_INLINE float transformed_direction(const float (&row)[4], const float (&v)[3]) {
  return (row[0] * v[0] + row[1] * v[1]) + row[2] * v[2];
}

TANDEM_RAY_QUERY_INLINE float transformed_point(const float (&row)[4], const float (&v)[3]) {
  return ((row[3] + row[0] * v[0]) + row[1] * v[1]) + row[2] * v[2];
}

TANDEM_RAY_QUERY_INLINE vec3 rayQueryGetIntersectionObjectRayDirectionEXT(rayQueryEXT& query, bool committed) {
  const Instance* instance = intersected_instance(query, committed);
  if (instance == nullptr) return vec3(0.0f);
  const auto& m = instance->world_to_object;
  const auto& v = query.ray.direction;
  return vec3(transformed_direction(m[0], v), transformed_direction(m[1], v), transformed_direction(m[2], v));
}

TANDEM_RAY_QUERY_INLINE vec3 rayQueryGetIntersectionObjectRayOriginEXT(rayQueryEXT& query, bool committed) {
  const Instance* instance = intersected_instance(query, committed);
  if (instance == nullptr) return vec3(0.0f);
  const auto& m = instance->world_to_object;
  const auto& v = query.ray.origin;
  return vec3(transformed_point(m[0], v), transformed_point(m[1], v), transformed_point(m[2], v));
}

TANDEM_RAY_QUERY_INLINE mat4x3 columns_of(const float (&rows)[3][4]) {
  return mat4x3(rows[0][0], rows[1][0], rows[2][0], rows[0][1], rows[1][1], rows[2][1], rows[0][2], rows[1][2],
                rows[2][2], rows[0][3], rows[1][3], rows[2][3]);
}

TANDEM_RAY_QUERY_INLINE mat4x3 rayQueryGetIntersectionObjectToWorldEXT(rayQueryEXT& query, bool committed) {
  const Instance* instance = intersected_instance(query, committed);
  return instance != nullptr ? columns_of(instance->object_to_world) : mat4x3(0.0f);
}

TANDEM_RAY_QUERY_INLINE mat4x3 rayQueryGetIntersectionWorldToObjectEXT(rayQueryEXT& query, bool committed) {
  const Instance* instance = intersected_instance(query, committed);
  return instance != nullptr ? columns_of(instance->world_to_object) : mat4x3(0.0f);
}

TANDEM_RAY_QUERY_INLINE float rayQueryGetRayTMinEXT(rayQueryEXT& query) { return query.ray.t_min; }

TANDEM_RAY_QUERY_INLINE uint rayQueryGetRayFlagsEXT(rayQueryEXT& query) { return query.ray.flags; }

TANDEM_RAY_QUERY_INLINE vec3 rayQueryGetWorldRayDirectionEXT(rayQueryEXT& query) {
  return vec3(query.ray.direction[0], query.ray.direction[1], query.ray.direction[2]);
}

TANDEM_RAY_QUERY_INLINE vec3 rayQueryGetWorldRayOriginEXT(rayQueryEXT& query) {
  return vec3(query.ray.origin[0], query.ray.origin[1], query.ray.origin[2]);
}

#undef TANDEM_RAY_QUERY_INLINE

}  // namespace tandem::kernel
