#pragma once

#include <bit>
#include <cstdint>

#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// GLSL_EXT_ray_query for translated shaders: a query is a small state machine that pulls hits out of
/// kernel::TraceFunctions. Everything is inline, and no function takes the address of a query or of a part of it, so
/// that the compiler can keep the members of a query in registers.
///
/// What GLSL leaves undefined is defined here: a query that was never initialised, or whose acceleration structure is
/// null, meets nothing; Proceed goes on returning false once it has; Confirm without a candidate does nothing; the
/// getters of a hit that does not exist give zero, but t of the committed hit gives t_max.
namespace tandem::kernel {

/// accelerationStructureEXT: refers to a built top level, or to nothing.
struct accelerationStructureEXT {
  const TopLevel* top_level = nullptr;
};

/// What rayQueryGetIntersectionTypeEXT returns of the committed hit; of a candidate it returns 0, a triangle.
inline constexpr uint committed_intersection_none = 0;
inline constexpr uint committed_intersection_triangle = 1;

/// In Hit::instance_index: there is no hit.
inline constexpr std::uint32_t no_instance = ~std::uint32_t{0};

enum class RayQueryState : std::uint8_t {
  complete,      ///< Proceed has nothing more to find
  initialized,   ///< not traced yet
  at_candidate,  ///< Proceed has returned true, and the candidate is not confirmed
  confirmed      ///< Confirm was called for the candidate
};

struct rayQueryEXT {
  const TopLevel* scene = nullptr;
  Ray ray = {};
  Hit committed = {.t = 0,
                   .barycentrics = {0, 0},
                   .instance_index = no_instance,
                   .geometry_index = 0,
                   .primitive_index = 0,
                   .front_face = false,
                   .opaque = false,
                   .is_box = false};
  Hit candidate = {.t = 0,
                   .barycentrics = {0, 0},
                   .instance_index = no_instance,
                   .geometry_index = 0,
                   .primitive_index = 0,
                   .front_face = false,
                   .opaque = false,
                   .is_box = false};
  RayQueryState state = RayQueryState::complete;
  bool has_committed = false;
  /// The committed hit is known to exist, but not yet which it is: most rays that stop at the first hit only ask
  /// whether there is one, which is the cheaper question.
  bool committed_is_unknown = false;
};

#define TANDEM_RAY_QUERY_INLINE [[gnu::always_inline]] inline

TANDEM_RAY_QUERY_INLINE void rayQueryInitializeEXT(rayQueryEXT& query, accelerationStructureEXT structure, uint flags,
                                                   uint mask, vec3 origin, float t_min, vec3 direction, float t_max) {
  query = rayQueryEXT{};
  query.scene = structure.top_level;
  query.ray = {
      {origin.x, origin.y, origin.z}, t_min, {direction.x, direction.y, direction.z}, t_max, flags, mask & 0xFF};
  query.committed.t = t_max;
  // Written so that a NaN at either end meets nothing too.
  const bool meets_anything =
      structure.top_level != nullptr && (mask & 0xFF) != 0 && (flags & ray_flag_skip_triangles) == 0 && t_min < t_max;
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

/// Whether some hit of the ray could need the shader's confirmation.
TANDEM_RAY_QUERY_INLINE bool can_meet_candidates(const TopLevel& scene, uint flags) {
  if ((flags & (ray_flag_opaque | ray_flag_cull_no_opaque)) != 0) return false;
  return (flags & ray_flag_no_opaque) != 0 || !scene.all_opaque;
}

TANDEM_RAY_QUERY_INLINE bool rayQueryProceedEXT(rayQueryEXT& query) {
  const RayQueryState state = query.state;
  query.state = RayQueryState::complete;
  // Candidates come in the order of t, so nothing after a confirmed one is nearer.
  if (state == RayQueryState::complete || state == RayQueryState::confirmed) return false;

  const TopLevel& scene = *query.scene;
  const Ray ray = vector_copy(query.ray);
  Hit hit;
  if (!can_meet_candidates(scene, ray.flags)) {
    if ((ray.flags & ray_flag_terminate_on_first_hit) != 0) {
      query.has_committed = query.committed_is_unknown = scene.functions->occluded(scene, ray);
    } else if (scene.functions->closest(scene, ray, hit)) {
      query.committed = hit;
      query.has_committed = true;
    }
    return false;
  }

  const Hit previous = query.candidate;
  const bool found =
      scene.functions->next_hits(scene, ray, state == RayQueryState::initialized ? nullptr : &previous, &hit, 1) == 1;
  if (!found) return false;
  if (hit.opaque) {
    query.committed = hit;
    query.has_committed = true;
    return false;
  }
  query.candidate = hit;
  query.state = RayQueryState::at_candidate;
  return true;
}

TANDEM_RAY_QUERY_INLINE void rayQueryTerminateEXT(rayQueryEXT& query) { query.state = RayQueryState::complete; }

TANDEM_RAY_QUERY_INLINE void rayQueryConfirmIntersectionEXT(rayQueryEXT& query) {
  if (query.state != RayQueryState::at_candidate) return;
  query.committed = query.candidate;
  query.has_committed = true;
  query.state = RayQueryState::confirmed;
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
  return committed && query.has_committed ? committed_intersection_triangle : committed_intersection_none;
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
