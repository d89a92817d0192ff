#pragma once

#include "rhi_cpu/kernel/ray_query.hpp"
#include "rhi_cpu/kernel/shader_call.hpp"
#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// GLSL_EXT_ray_tracing for translated shaders: what they call, and the built-ins that are more than a member of their
/// ShaderCall. Of the operands only the bits that SPV_KHR_ray_tracing names are looked at.
namespace tandem::kernel {

/// `payload` is the caller's own variable, which the shaders of the hit or of the miss change.
template <typename Payload>
inline void traceRayEXT(ShaderCall& call, accelerationStructureEXT structure, uint flags, uint mask,
                        uint sbt_record_offset, uint sbt_record_stride, uint miss_index, vec3 origin, float t_min,
                        vec3 direction, float t_max, Payload& payload) {
  const Ray ray = vector_copy(
      {{origin.x, origin.y, origin.z}, t_min, {direction.x, direction.y, direction.z}, t_max, flags, mask & 0xFF});
  call.functions->trace_ray(call, structure.top_level, ray, sbt_record_offset & 0xF, sbt_record_stride & 0xF,
                            miss_index & 0xFFFF, &payload, sizeof(Payload));
}

template <typename Data>
inline void executeCallableEXT(ShaderCall& call, uint index, Data& data) {
  call.functions->execute_callable(call, index, &data, sizeof(Data));
}

/// The shader has to end at once when call.decision is HitDecision::terminate afterwards.
inline bool reportIntersectionEXT(ShaderCall& call, float t, uint hit_kind) {
  return call.functions->report_intersection(call, t, hit_kind);
}

inline uvec3 launch_id(const ShaderCall& call) {
  return uvec3(call.launch_id[0], call.launch_id[1], call.launch_id[2]);
}
inline uvec3 launch_size(const ShaderCall& call) {
  return uvec3(call.launch_size[0], call.launch_size[1], call.launch_size[2]);
}

inline vec3 world_ray_origin(const ShaderCall& call) {
  const auto& v = call.ray->origin;
  return vec3(v[0], v[1], v[2]);
}
inline vec3 world_ray_direction(const ShaderCall& call) {
  const auto& v = call.ray->direction;
  return vec3(v[0], v[1], v[2]);
}

// To the last bit what a ray query gives.
inline vec3 object_ray_origin(const ShaderCall& call) {
  const auto& m = call.instance->world_to_object;
  const auto& v = call.ray->origin;
  return vec3(transformed_point(m[0], v), transformed_point(m[1], v), transformed_point(m[2], v));
}
inline vec3 object_ray_direction(const ShaderCall& call) {
  const auto& m = call.instance->world_to_object;
  const auto& v = call.ray->direction;
  return vec3(transformed_direction(m[0], v), transformed_direction(m[1], v), transformed_direction(m[2], v));
}

}  // namespace tandem::kernel
