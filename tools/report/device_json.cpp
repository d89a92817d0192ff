#include "tools/report/device_json.hpp"

namespace tandem::tools {

nlohmann::ordered_json number_or_null(std::uint32_t value) {
  constexpr std::uint32_t none = 0xffffffffu;
  return value == none ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(value);
}

const char* kind_name(rhi::DeviceKind kind) {
  switch (kind) {
    case rhi::DeviceKind::discrete_gpu:
      return "discrete GPU";
    case rhi::DeviceKind::integrated_gpu:
      return "integrated GPU";
    case rhi::DeviceKind::virtual_gpu:
      return "virtual GPU";
    case rhi::DeviceKind::cpu:
      return "CPU";
  }
  return "unknown";
}

namespace {

nlohmann::ordered_json to_json(const rhi::FormatSupport& support) {
  return {{"storage", support.storage},
          {"storage_atomic", support.storage_atomic},
          {"sampled", support.sampled},
          {"filtered", support.filtered},
          {"uniform_texel_buffer", support.uniform_texel_buffer},
          {"storage_texel_buffer", support.storage_texel_buffer}};
}

}  // namespace

nlohmann::ordered_json to_json(const rhi::DeviceInfo& device) {
  return {{"name", device.name},     {"backend", device.backend}, {"description", device.description},
          {"driver", device.driver}, {"api", device.api},         {"kind", kind_name(device.kind)}};
}

nlohmann::ordered_json to_json_in_full(const rhi::DeviceInfo& device) {
  nlohmann::ordered_json json = to_json(device);
  const rhi::Capabilities& capabilities = device.capabilities;
  json["capabilities"] = {{"ray_query", capabilities.ray_query},
                          {"ray_tracing_pipeline", capabilities.ray_tracing_pipeline},
                          {"position_fetch", capabilities.position_fetch},
                          {"trace_rays_indirect", capabilities.trace_rays_indirect},
                          {"primitive_culling", capabilities.primitive_culling},
                          {"null_acceleration_structure", capabilities.null_acceleration_structure},
                          {"buffer_references", capabilities.buffer_references},
                          {"non_uniform_indexing", capabilities.non_uniform_indexing},
                          {"unsized_arrays", capabilities.unsized_arrays},
                          {"partially_bound", capabilities.partially_bound},
                          {"cube_arrays", capabilities.cube_arrays},
                          {"scalar_block_layout", capabilities.scalar_block_layout},
                          {"shader_int8", capabilities.shader_int8},
                          {"shader_int16", capabilities.shader_int16},
                          {"shader_int64", capabilities.shader_int64},
                          {"shader_float16", capabilities.shader_float16},
                          {"shader_float64", capabilities.shader_float64},
                          {"timestamps", capabilities.timestamps},
                          {"zeroed_workgroup_memory", capabilities.zeroed_workgroup_memory},
                          {"workgroup_memory_layout", capabilities.workgroup_memory_layout},
                          {"workgroup_memory_layout_8bit", capabilities.workgroup_memory_layout_8bit},
                          {"workgroup_memory_layout_16bit", capabilities.workgroup_memory_layout_16bit},
                          {"shared_int64_atomics", capabilities.shared_int64_atomics},
                          {"shared_float32_atomics", capabilities.shared_float32_atomics},
                          {"shared_float32_atomic_add", capabilities.shared_float32_atomic_add},
                          {"shared_float32_atomic_min_max", capabilities.shared_float32_atomic_min_max},
                          {"shared_float64_atomic_add", capabilities.shared_float64_atomic_add},
                          {"subgroup_basic", capabilities.subgroup_basic},
                          {"subgroup_vote", capabilities.subgroup_vote},
                          {"subgroup_arithmetic", capabilities.subgroup_arithmetic},
                          {"subgroup_ballot", capabilities.subgroup_ballot},
                          {"subgroup_shuffle", capabilities.subgroup_shuffle},
                          {"subgroup_shuffle_relative", capabilities.subgroup_shuffle_relative},
                          {"subgroup_clustered", capabilities.subgroup_clustered},
                          {"subgroup_quad", capabilities.subgroup_quad},
                          {"subgroup_rotate", capabilities.subgroup_rotate},
                          {"subgroup_clustered_rotate", capabilities.subgroup_clustered_rotate},
                          {"subgroup_extended_types", capabilities.subgroup_extended_types},
                          {"required_subgroup_size", capabilities.required_subgroup_size},
                          {"full_subgroups", capabilities.full_subgroups},
                          {"subgroup_uniform_control_flow", capabilities.subgroup_uniform_control_flow},
                          {"maximal_reconvergence", capabilities.maximal_reconvergence}};
  const rhi::Limits& limits = device.limits;
  json["limits"] = {{"max_push_constant_size", limits.max_push_constant_size},
                    {"max_storage_buffer_range", limits.max_storage_buffer_range},
                    {"max_uniform_buffer_range", limits.max_uniform_buffer_range},
                    {"storage_buffer_offset_alignment", limits.storage_buffer_offset_alignment},
                    {"uniform_buffer_offset_alignment", limits.uniform_buffer_offset_alignment},
                    {"max_workgroup_size", limits.max_workgroup_size},
                    {"max_workgroup_invocations", limits.max_workgroup_invocations},
                    {"workgroup_memory_size", limits.workgroup_memory_size},
                    {"subgroup_size", limits.subgroup_size},
                    {"min_subgroup_size", limits.min_subgroup_size},
                    {"max_subgroup_size", limits.max_subgroup_size},
                    {"max_workgroup_subgroups", limits.max_workgroup_subgroups},
                    {"max_workgroup_count", limits.max_workgroup_count},
                    {"max_bind_groups", limits.max_bind_groups},
                    {"max_geometry_count", limits.max_geometry_count},
                    {"max_primitive_count", limits.max_primitive_count},
                    {"max_instance_count", limits.max_instance_count}};
  for (std::size_t i = 0; i < device.formats.size(); ++i)
    json["formats"][std::string(rhi::info_of(static_cast<rhi::TextureFormat>(i)).name)] = to_json(device.formats[i]);
  return json;
}

std::string json_text(const nlohmann::ordered_json& value) {
  return value.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace tandem::tools
