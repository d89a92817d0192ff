#pragma once

#include <functional>
#include <string>
#include <vector>

#include "conformance/kit/case.hpp"

/// The groups, in the order of the report: each function appends its cases.
namespace tandem::conformance {

using Cases = std::vector<Case>;

/// Appends cases that share their group and what they need.
struct Group {
  Cases& cases;
  std::string name;  ///< group.subgroup
  std::vector<Capability> needs = {&rhi::Capabilities::ray_query};

  void add(const std::string& last_name, const std::string& behaviour, std::function<void(Context&)> run) const;
};

void add_device_cases(Cases& cases);
void add_compute_cases(Cases& cases);
void add_descriptor_cases(Cases& cases);
void add_arithmetic_cases(Cases& cases);
void add_storage_image_cases(Cases& cases);
void add_sampler_cases(Cases& cases);
void add_shared_memory_cases(Cases& cases);
void add_shared_atomic_cases(Cases& cases);
void add_barrier_cases(Cases& cases);
void add_subgroup_basic_cases(Cases& cases);
void add_subgroup_arithmetic_cases(Cases& cases);
void add_subgroup_shuffle_cases(Cases& cases);
void add_subgroup_divergence_cases(Cases& cases);
void add_divergent_operation_cases(Cases& cases);
void add_subgroup_idiom_cases(Cases& cases);
void add_ray_query_builtin_cases(Cases& cases);
void add_ray_query_traversal_cases(Cases& cases);
void add_ray_query_procedural_cases(Cases& cases);
void add_ray_query_flag_cases(Cases& cases);
void add_ray_query_range_cases(Cases& cases);
void add_ray_query_multiple_cases(Cases& cases);
void add_ray_query_watertightness_cases(Cases& cases);
void add_acceleration_structure_format_cases(Cases& cases);
void add_acceleration_structure_build_cases(Cases& cases);
void add_acceleration_structure_instance_cases(Cases& cases);
void add_acceleration_structure_update_cases(Cases& cases);
void add_pipeline_cases(Cases& cases);

}  // namespace tandem::conformance
