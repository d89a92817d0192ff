#pragma once

#include <cstddef>
#include <cstdint>

#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/kernel/trace.hpp"

/// One run of one shader of a ray tracing pipeline: what the host (rhi_cpu) gives it, and what it calls back.
namespace tandem::kernel {

/// What an any-hit shader says of its candidate.
enum class HitDecision : std::uint32_t {
  accept,    ///< it returned normally
  ignore,    ///< ignoreIntersectionEXT
  terminate  ///< terminateRayEXT: accepted, and the ray looks no further
};

struct ShaderCall;

/// What shaders call. `caller` is the call that they were given.
struct PipelineFunctions {
  /// traceRayEXT. `scene` may be null. `payload` is the caller's own variable.
  void (*trace_ray)(ShaderCall& caller, const TopLevel* scene, const Ray& ray, std::uint32_t sbt_record_offset,
                    std::uint32_t sbt_record_stride, std::uint32_t miss_index, void* payload,
                    std::uint32_t payload_size);
  /// executeCallableEXT.
  void (*execute_callable)(ShaderCall& caller, std::uint32_t index, void* data, std::uint32_t data_size);
  /// reportIntersectionEXT, of an intersection shader: runs the any-hit shader, if there is one to run, and returns
  /// whether the hit was accepted. The attributes are those in caller.hit_attributes. When it returns with
  /// caller.decision == HitDecision::terminate, the intersection shader has to end at once.
  bool (*report_intersection)(ShaderCall& caller, float t, std::uint32_t hit_kind);
};

/// Hit kinds of triangles: gl_HitKindFrontFacingTriangleEXT and gl_HitKindBackFacingTriangleEXT.
inline constexpr std::uint32_t hit_kind_front_facing_triangle = 0xFE;
inline constexpr std::uint32_t hit_kind_back_facing_triangle = 0xFF;

/// Bytes that hit attributes can have.
inline constexpr std::uint32_t max_hit_attribute_size = 32;

struct ShaderCall {
  const PipelineFunctions* functions = nullptr;
  void* host = nullptr;                 ///< the host's own; handed on
  const Resource* resources = nullptr;  ///< KernelInfo::resource_count of this shader
  const std::byte* push_constants = nullptr;
  const std::byte* shader_record = nullptr;  ///< its shaderRecordEXT block, aligned to 16
  std::uint32_t launch_id[3] = {0, 0, 0};
  std::uint32_t launch_size[3] = {1, 1, 1};
  std::uint32_t depth = 0;       ///< rays in flight: 0 in the ray generation shader
  const Watch* watch = nullptr;  ///< for kernels that look at it

  /// The variable of the caller that holds the incoming payload, or the callable data.
  void* payload = nullptr;
  std::uint32_t payload_size = 0;
  /// Any-hit and closest-hit: the attributes of the hit, a vec2 of barycentrics for triangles. Intersection: where it
  /// writes them before reportIntersectionEXT. max_hit_attribute_size bytes, aligned to 16.
  void* hit_attributes = nullptr;

  const Ray* ray = nullptr;  ///< the ray in flight as it was traced; null in ray generation and callable shaders
  float t = 0;               ///< gl_RayTmaxEXT, gl_HitTEXT: of the hit, or as far as the ray still looks
  std::uint32_t hit_kind = 0;
  const Hit* hit = nullptr;                    ///< any-hit, closest-hit, intersection
  const Instance* instance = nullptr;          ///< of `hit`
  HitDecision decision = HitDecision::accept;  ///< set by any-hit shaders; see report_intersection
};

}  // namespace tandem::kernel
