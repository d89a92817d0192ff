#include "conformance/kit/cases.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tandem::conformance {
namespace {

using rhi::Capabilities;

constexpr std::pair<Capability, std::string_view> capability_names[] = {
    {&Capabilities::ray_query, "ray_query"},
    {&Capabilities::ray_tracing_pipeline, "ray_tracing_pipeline"},
    {&Capabilities::position_fetch, "position_fetch"},
    {&Capabilities::trace_rays_indirect, "trace_rays_indirect"},
    {&Capabilities::primitive_culling, "primitive_culling"},
    {&Capabilities::null_acceleration_structure, "null_acceleration_structure"},
    {&Capabilities::buffer_references, "buffer_references"},
    {&Capabilities::non_uniform_indexing, "non_uniform_indexing"},
    {&Capabilities::unsized_arrays, "unsized_arrays"},
    {&Capabilities::partially_bound, "partially_bound"},
    {&Capabilities::cube_arrays, "cube_arrays"},
    {&Capabilities::scalar_block_layout, "scalar_block_layout"},
    {&Capabilities::shader_int8, "shader_int8"},
    {&Capabilities::shader_int16, "shader_int16"},
    {&Capabilities::shader_int64, "shader_int64"},
    {&Capabilities::shader_float16, "shader_float16"},
    {&Capabilities::shader_float64, "shader_float64"},
    {&Capabilities::timestamps, "timestamps"},
    {&Capabilities::zeroed_workgroup_memory, "zeroed_workgroup_memory"},
    {&Capabilities::workgroup_memory_layout, "workgroup_memory_layout"},
    {&Capabilities::workgroup_memory_layout_8bit, "workgroup_memory_layout_8bit"},
    {&Capabilities::workgroup_memory_layout_16bit, "workgroup_memory_layout_16bit"},
    {&Capabilities::shared_int64_atomics, "shared_int64_atomics"},
    {&Capabilities::shared_float32_atomics, "shared_float32_atomics"},
    {&Capabilities::shared_float32_atomic_add, "shared_float32_atomic_add"},
    {&Capabilities::shared_float32_atomic_min_max, "shared_float32_atomic_min_max"},
    {&Capabilities::shared_float64_atomic_add, "shared_float64_atomic_add"},
    {&Capabilities::subgroup_basic, "subgroup_basic"},
    {&Capabilities::subgroup_vote, "subgroup_vote"},
    {&Capabilities::subgroup_arithmetic, "subgroup_arithmetic"},
    {&Capabilities::subgroup_ballot, "subgroup_ballot"},
    {&Capabilities::subgroup_shuffle, "subgroup_shuffle"},
    {&Capabilities::subgroup_shuffle_relative, "subgroup_shuffle_relative"},
    {&Capabilities::subgroup_clustered, "subgroup_clustered"},
    {&Capabilities::subgroup_quad, "subgroup_quad"},
    {&Capabilities::subgroup_rotate, "subgroup_rotate"},
    {&Capabilities::subgroup_clustered_rotate, "subgroup_clustered_rotate"},
    {&Capabilities::subgroup_extended_types, "subgroup_extended_types"},
    {&Capabilities::required_subgroup_size, "required_subgroup_size"},
    {&Capabilities::full_subgroups, "full_subgroups"},
    {&Capabilities::subgroup_uniform_control_flow, "subgroup_uniform_control_flow"},
    {&Capabilities::maximal_reconvergence, "maximal_reconvergence"},
};

}  // namespace

std::string_view name_of(Capability capability) {
  const auto* const found = std::find_if(std::begin(capability_names), std::end(capability_names),
                                         [capability](const auto& entry) { return entry.first == capability; });
  return found == std::end(capability_names) ? "a capability without a name" : found->second;
}

std::string_view group_of(std::string_view case_name) { return case_name.substr(0, case_name.rfind('.')); }

void Group::add(const std::string& last_name, const std::string& behaviour, std::function<void(Context&)> run) const {
  cases.push_back({.name = name + "." + last_name, .behaviour = behaviour, .needs = needs, .run = std::move(run)});
}

std::vector<Case> all_cases() {
  Cases cases;
  add_device_cases(cases);
  add_compute_cases(cases);
  add_descriptor_cases(cases);
  add_arithmetic_cases(cases);
  add_storage_image_cases(cases);
  add_sampler_cases(cases);
  add_shared_memory_cases(cases);
  add_shared_atomic_cases(cases);
  add_barrier_cases(cases);
  add_subgroup_basic_cases(cases);
  add_subgroup_arithmetic_cases(cases);
  add_subgroup_shuffle_cases(cases);
  add_subgroup_divergence_cases(cases);
  add_divergent_operation_cases(cases);
  add_subgroup_idiom_cases(cases);
  add_ray_query_builtin_cases(cases);
  add_ray_query_traversal_cases(cases);
  add_ray_query_procedural_cases(cases);
  add_ray_query_flag_cases(cases);
  add_ray_query_range_cases(cases);
  add_ray_query_multiple_cases(cases);
  add_ray_query_watertightness_cases(cases);
  add_acceleration_structure_format_cases(cases);
  add_acceleration_structure_build_cases(cases);
  add_acceleration_structure_instance_cases(cases);
  add_acceleration_structure_update_cases(cases);
  add_pipeline_cases(cases);
  return cases;
}

}  // namespace tandem::conformance
