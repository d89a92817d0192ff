#include "conformance/ray_query/probe.hpp"

#include <algorithm>
#include <span>
#include <string>

#include "conformance/kit/check.hpp"

namespace tandem::conformance {
namespace {

const std::string probe_source = R"(#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 32) in;

const uint ANY = 0xffffffffu;
const uint CONFIRM = 1u, GENERATE = 2u, GENERATE_SECOND = 4u, TERMINATE = 8u;
const uint MOST_CANDIDATES = 12u;

struct Ray {
  vec3 origin; float t_min; vec3 direction; float t_max;
  uint flags; uint mask; uint first_decision; uint decision_count;
};
struct Decision { uint actions; uint instance; uint geometry; uint primitive; float t; float second_t; uvec2 padding; };
struct Intersection {
  uint type; uint instance; uint custom_index; uint sbt_offset;
  uint geometry; uint primitive; uint front_face; uint box_opaque;
  float t; float u; float v; uint committed_type_after;
  vec3 object_origin; float committed_t_after;
  vec3 object_direction; uint padding;
  vec4 object_to_world[3]; vec4 world_to_object[3];
};
struct Traversal {
  vec3 world_origin; float t_min; vec3 world_direction; uint flags;
  uint candidate_count; uint padding[3];
  Intersection committed;
  Intersection candidates[MOST_CANDIDATES];
};

layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 0, binding = 2, std430) readonly buffer Decisions { Decision decisions[]; };
layout(set = 0, binding = 3, std430) buffer Traversals { Traversal traversals[]; };
layout(push_constant) uniform Constants { uint ray_count; };

vec4 row(mat4x3 matrix, int r) { return vec4(matrix[0][r], matrix[1][r], matrix[2][r], matrix[3][r]); }

// Getters take a constant, so this is text for both kinds of intersection.
#define RECORD(target, committed)                                                                             \
  target.instance = uint(rayQueryGetIntersectionInstanceIdEXT(query, committed));                             \
  target.custom_index = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, committed));                \
  target.sbt_offset = rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(query, committed);     \
  target.geometry = uint(rayQueryGetIntersectionGeometryIndexEXT(query, committed));                          \
  target.primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, committed));                        \
  target.object_origin = rayQueryGetIntersectionObjectRayOriginEXT(query, committed);                         \
  target.object_direction = rayQueryGetIntersectionObjectRayDirectionEXT(query, committed);                   \
  for (int r = 0; r < 3; ++r) {                                                                               \
    target.object_to_world[r] = row(rayQueryGetIntersectionObjectToWorldEXT(query, committed), r);            \
    target.world_to_object[r] = row(rayQueryGetIntersectionWorldToObjectEXT(query, committed), r);            \
  }
#define RECORD_TRIANGLE(target, committed)                                                  \
  target.front_face = rayQueryGetIntersectionFrontFaceEXT(query, committed) ? 1u : 0u;      \
  target.u = rayQueryGetIntersectionBarycentricsEXT(query, committed).x;                    \
  target.v = rayQueryGetIntersectionBarycentricsEXT(query, committed).y;
#define CLOSEST                                                                                                   \
  (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT                         \
       ? ray.t_max                                                                                                \
       : rayQueryGetIntersectionTEXT(query, true))

Intersection nothing() {
  Intersection result;
  result.type = result.instance = result.custom_index = result.sbt_offset = 0u;
  result.geometry = result.primitive = result.front_face = result.box_opaque = 0u;
  result.t = result.u = result.v = result.committed_t_after = 0.0;
  result.committed_type_after = result.padding = 0u;
  result.object_origin = result.object_direction = vec3(0.0);
  for (int r = 0; r < 3; ++r) result.object_to_world[r] = result.world_to_object[r] = vec4(0.0);
  return result;
}

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= ray_count) return;
  Ray ray = rays[index];
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, ray.flags, ray.mask, ray.origin, ray.t_min, ray.direction, ray.t_max);
  uint count = 0u;
  while (rayQueryProceedEXT(query)) {
    Intersection candidate = nothing();
    candidate.type = rayQueryGetIntersectionTypeEXT(query, false);
    RECORD(candidate, false)
    if (candidate.type == gl_RayQueryCandidateIntersectionTriangleEXT) {
      RECORD_TRIANGLE(candidate, false)
      candidate.t = rayQueryGetIntersectionTEXT(query, false);
    } else {
      candidate.box_opaque = rayQueryGetIntersectionCandidateAABBOpaqueEXT(query) ? 1u : 0u;
    }
    for (uint i = 0u; i < ray.decision_count; ++i) {
      Decision decision = decisions[ray.first_decision + i];
      if (decision.instance != ANY && decision.instance != candidate.instance) continue;
      if (decision.geometry != ANY && decision.geometry != candidate.geometry) continue;
      if (decision.primitive != ANY && decision.primitive != candidate.primitive) continue;
      if ((decision.actions & CONFIRM) != 0u) rayQueryConfirmIntersectionEXT(query);
      // A hit that is generated must not be behind what is committed.
      if ((decision.actions & GENERATE) != 0u && decision.t <= CLOSEST)
        rayQueryGenerateIntersectionEXT(query, decision.t);
      if ((decision.actions & GENERATE_SECOND) != 0u && decision.second_t <= CLOSEST)
        rayQueryGenerateIntersectionEXT(query, decision.second_t);
      if ((decision.actions & TERMINATE) != 0u) rayQueryTerminateEXT(query);
      break;
    }
    candidate.committed_type_after = rayQueryGetIntersectionTypeEXT(query, true);
    if (candidate.committed_type_after != gl_RayQueryCommittedIntersectionNoneEXT)
      candidate.committed_t_after = rayQueryGetIntersectionTEXT(query, true);
    if (count < MOST_CANDIDATES) traversals[index].candidates[count] = candidate;
    ++count;
  }
  traversals[index].candidate_count = count;
  traversals[index].world_origin = rayQueryGetWorldRayOriginEXT(query);
  traversals[index].world_direction = rayQueryGetWorldRayDirectionEXT(query);
  traversals[index].t_min = rayQueryGetRayTMinEXT(query);
  traversals[index].flags = rayQueryGetRayFlagsEXT(query);
  Intersection committed = nothing();
  committed.type = rayQueryGetIntersectionTypeEXT(query, true);
  if (committed.type != gl_RayQueryCommittedIntersectionNoneEXT) {
    RECORD(committed, true)
    committed.t = rayQueryGetIntersectionTEXT(query, true);
    if (committed.type == gl_RayQueryCommittedIntersectionTriangleEXT) {
      RECORD_TRIANGLE(committed, true)
    }
  }
  traversals[index].committed = committed;
}
)";

/// The shader's Ray.
struct RayData {
  glm::vec3 origin;
  float t_min;
  glm::vec3 direction;
  float t_max;
  std::uint32_t flags;
  std::uint32_t mask;
  std::uint32_t first_decision;
  std::uint32_t decision_count;
};
static_assert(sizeof(RayData) == 48);

/// The shader's Traversal.
struct TraversalData {
  glm::vec3 world_origin = {};
  float t_min = 0;
  glm::vec3 world_direction = {};
  std::uint32_t flags = 0;
  std::uint32_t candidate_count = 0;
  std::array<std::uint32_t, 3> padding = {};
  Intersection committed;
  std::array<Intersection, most_candidates> candidates;
};
static_assert(sizeof(TraversalData) == 48 + 13 * 176);

Traversal traversal_of(const TraversalData& data) {
  Traversal traversal = {.world_origin = data.world_origin,
                         .t_min = data.t_min,
                         .world_direction = data.world_direction,
                         .flags = data.flags,
                         .committed = data.committed,
                         .candidate_count = data.candidate_count,
                         .candidates = {}};
  const std::uint32_t stored = std::min(data.candidate_count, most_candidates);
  traversal.candidates.assign(data.candidates.begin(), data.candidates.begin() + stored);
  return traversal;
}

void check_ids(std::string_view what, const Intersection& seen, const Ids& expected) {
  check_equal(fmt::format("{}: the instance", what), seen.instance, expected.instance);
  check_equal(fmt::format("{}: the geometry", what), seen.geometry, expected.geometry);
  check_equal(fmt::format("{}: the primitive", what), seen.primitive, expected.primitive);
}

}  // namespace

void check_miss(std::string_view what, const Traversal& traversal) {
  check_equal(fmt::format("{}: the committed type", what), traversal.committed.type, committed_type::none);
}

void check_triangle(std::string_view what, const Traversal& traversal, const Ids& ids, double t) {
  check_equal(fmt::format("{}: the committed type", what), traversal.committed.type, committed_type::triangle);
  check_ids(what, traversal.committed, ids);
  check_close(fmt::format("{}: t", what), traversal.committed.t, t);
}

void check_generated(std::string_view what, const Traversal& traversal, const Ids& ids, float t) {
  check_equal(fmt::format("{}: the committed type", what), traversal.committed.type, committed_type::generated);
  check_ids(what, traversal.committed, ids);
  check_equal(fmt::format("{}: t", what), traversal.committed.t, t);
}

std::vector<Traversal> trace(Context& context, const rhi::AccelerationStructureHandle& top_level,
                             const std::vector<Ray>& rays) {
  std::vector<RayData> ray_data;
  std::vector<Decision> decisions;
  for (const Ray& ray : rays) {
    ray_data.push_back({ray.origin, ray.t_min, ray.direction, ray.t_max, ray.flags, ray.mask,
                        static_cast<std::uint32_t>(decisions.size()),
                        static_cast<std::uint32_t>(ray.decisions.size())});
    decisions.insert(decisions.end(), ray.decisions.begin(), ray.decisions.end());
  }
  if (decisions.empty()) decisions.emplace_back();  // a buffer has at least one byte

  rhi::Device& device = context.device();
  const rhi::ComputePipelineHandle pipeline = context.compute_pipeline(probe_source, "ray query probe");
  const rhi::BufferHandle results = buffer_of(device, std::vector<TraversalData>(rays.size()), "traversals");
  const rhi::BindGroupHandle group = device.create_bind_group(
      {.pipeline = pipeline,
       .entries = {{.binding = 0, .resource = top_level},
                   {.binding = 1, .resource = rhi::BufferRange{buffer_of(device, ray_data, "rays")}},
                   {.binding = 2, .resource = rhi::BufferRange{buffer_of(device, decisions, "decisions")}},
                   {.binding = 3, .resource = rhi::BufferRange{results}}},
       .label = "ray query probe"});
  const auto ray_count = static_cast<std::uint32_t>(rays.size());
  const rhi::CommandListHandle list = device.create_command_list("ray query probe");
  list->dispatch({.pipeline = pipeline,
                  .bind_groups = {group},
                  .push_constants = std::as_bytes(std::span(&ray_count, 1)),
                  .workgroup_count = {(ray_count + 31) / 32, 1, 1}});
  device.submit(list);
  std::vector<Traversal> traversals;
  for (const TraversalData& data : rhi::read<TraversalData>(device, results, rays.size()))
    traversals.push_back(traversal_of(data));
  return traversals;
}

Traversal trace(Context& context, const rhi::AccelerationStructureHandle& top_level, const Ray& ray) {
  return trace(context, top_level, std::vector<Ray>{ray}).front();
}

}  // namespace tandem::conformance
